// Definitions of partly_linear_motion.hpp.
#pragma once

#include <palpate/model/moving/detail/partly_linear_motion.hpp>
#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>
#include <palpate/model/admission_report.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE PartlyLinearMotion::PartlyLinearMotion(BodyParts parts, std::unique_ptr<TissueMotion> near,
                                                      std::unique_ptr<LinearSurroundings> surroundings,
                                                      const VectorX& load, const std::vector<Vector3>& positions)
    : parts_(std::move(parts)),
      surroundings_(std::move(surroundings)),
      near_(std::move(near)),
      kept_(dofs_in(parts_.near, parts_.far, surroundings_->kept())),
      far_displacement_(parts_, positions, *surroundings_, largest_linear_displacement * extent(positions)),
      u_(detail::zeros(load.size())),
      v_(u_),
      load_(load),
      near_vector_(detail::zeros(near_->displacement().size())),
      far_vector_(detail::zeros(3 * static_cast<Index>(parts_.far.nodes.size()))),
      kept_moved_(detail::zeros(static_cast<Index>(kept_.size()))),
      extended_(far_vector_) {
  for (const Index dof : kept_)
    kept_in_body_.push_back(3 * Index{parts_.near.nodes[static_cast<std::size_t>(dof / 3)]} + dof % 3);
  set_load(load);
  far_displacement_.set_from_load(surroundings_->from_load().displacement);
  springs_.reserve(most_springs);
  take_displacement();
}

PALPATE_INLINE MotionStep PartlyLinearMotion::step(double h) noexcept {
  MotionStep done = near_->step(h);
  if (Index& worst = done.deformation.worst_element; worst >= 0)
    worst = parts_.near.elements[static_cast<std::size_t>(worst)];
  stepped_ = done.taken;
  if (!done.taken) return done;
  take_displacement();
  if (far_displacement_.is_too_large(u_)) done.status.set(StatusFlag::large_displacement);
  return done;
}

PALPATE_INLINE bool PartlyLinearMotion::set_springs(std::span<const ContactSpring> springs) noexcept {
  copy_springs(springs, springs_);
  for (ContactSpring& s : springs_)
    for (NodeId& node : s.nodes) node = parts_.near.local(node);
  return near_->set_springs(springs_);
}

PALPATE_INLINE void PartlyLinearMotion::take_displacement() noexcept {
  if (std::exchange(far_changed_, false)) {
    far_vector_ = surroundings_->from_load().displacement + surroundings_->from_prescribed().displacement;
    parts_.far.scatter(far_vector_, u_);
  }
  parts_.near.scatter(near_->displacement(), u_);
}

PALPATE_INLINE void PartlyLinearMotion::complete(VectorX& u) noexcept {
  for (std::size_t i = 0; i < kept_.size(); ++i) kept_moved_[static_cast<Index>(i)] = u[kept_in_body_[i]];
  surroundings_->extend(kept_moved_, extended_);
  for (std::size_t i = 0; i < parts_.far.nodes.size(); ++i)
    if (!surroundings_->is_interface(i))
      add_node_vector(u, Index{parts_.far.nodes[i]}, node_vector(extended_, static_cast<Index>(i)));
}

PALPATE_INLINE bool PartlyLinearMotion::respond(const VectorX& forces, VectorX& u) noexcept {
  parts_.near.gather(forces, near_vector_);
  if (!near_->respond(near_vector_, near_vector_)) return false;
  detail::fill(u, 0.0);
  parts_.near.scatter(near_vector_, u);
  return true;
}

PALPATE_INLINE void PartlyLinearMotion::rest_at(const VectorX& u) {
  require_entries(u, u_.size());
  parts_.near.gather(u, near_vector_);
  near_->rest_at(near_vector_);
  stepped_ = false;
  take_displacement();
}

PALPATE_INLINE void PartlyLinearMotion::set_load(const VectorX& load) {
  require_entries(load, u_.size());
  load_ = load;
  parts_.far.gather(load, far_vector_);
  if (surroundings_->set_load(far_vector_)) {
    far_displacement_.set_from_load(surroundings_->from_load().displacement);
    far_changed_ = true;
  }
  load_near();
}

PALPATE_INLINE void PartlyLinearMotion::set_prescribed(const VectorX& values) {
  require_entries(values, u_.size());
  parts_.far.gather(values, far_vector_);
  far_changed_ = surroundings_->set_prescribed(far_vector_) || far_changed_;
  parts_.near.gather(values, near_vector_);
  near_->set_prescribed(near_vector_);
  load_near();
}

PALPATE_INLINE void PartlyLinearMotion::load_near() noexcept {
  parts_.near.gather(load_, near_vector_);
  for (std::size_t i = 0; i < kept_.size(); ++i)
    near_vector_[kept_[i]] += surroundings_->kept_load(static_cast<Index>(i));
  near_->set_load(near_vector_);
}

namespace detail {

PALPATE_INLINE PreparedMotion prepare_partly_linear(DeformableBody whole, BodyParts parts,
                                                    const BlockPattern& near_pattern, const BlockMatrix& near_stiffness,
                                                    StiffnessAt near_stiffness_at,
                                                    std::unique_ptr<EnergyForces> near_forces,
                                                    std::unique_ptr<LinearSurroundings> surroundings,
                                                    const QuasiNewtonParameters& parameters,
                                                    const SetupLimits& limits) {
  const std::vector<Index> kept = dofs_in(parts.near, parts.far, surroundings->kept());
  DeformableBody near;
  near.conditions = conditions_of(parts.near, whole.conditions);
  near.pattern = near_pattern;
  near.load = zeros(near.conditions.dof_count());
  parts.near.gather(whole.load, near.load);
  near.lumped = zeros(static_cast<Index>(parts.near.nodes.size()));
  for (std::size_t i = 0; i < parts.near.nodes.size(); ++i) {
    near.lumped[static_cast<Index>(i)] = whole.lumped[parts.near.nodes[i]];
    near.positions.push_back(whole.positions[static_cast<std::size_t>(parts.near.nodes[i])]);
  }
  VectorX far_load = zeros(3 * static_cast<Index>(parts.far.nodes.size()));
  parts.far.gather(whole.load, far_load);
  surroundings->set_load(far_load);
  for (std::size_t i = 0; i < kept.size(); ++i) near.load[kept[i]] += surroundings->kept_load(static_cast<Index>(i));

  const auto joint =
      std::make_shared<SurroundedStiffness>(near_stiffness.pattern(), surroundings->stiffness(), kept, limits);
  BlockMatrix stiffness = make_stiffness(joint->pattern(), limits);
  joint->add_up(near_stiffness, stiffness);
  StiffnessAt stiffness_at;
  if (near_stiffness_at)
    stiffness_at = [joint, part = near_stiffness, at = std::move(near_stiffness_at)](const VectorX& u,
                                                                                     BlockMatrix& k) mutable {
      if (!at(u, part)) return false;
      joint->add_up(part, k);
      return true;
    };
  auto factor = std::make_shared<RenewableFactor>(near, std::move(stiffness), parts.interface_in(parts.near),
                                                  std::move(stiffness_at), limits);
  auto motion = std::make_unique<QuasiNewtonMotion>(
      std::move(near), std::make_unique<SurroundedForces>(std::move(near_forces), surroundings->stiffness(), kept),
      std::move(factor), parameters);
  motion->begin();
  PreparedMotion prepared;
  prepared.large_strain = true;
  prepared.motion = std::make_unique<PartlyLinearMotion>(std::move(parts), std::move(motion), std::move(surroundings),
                                                         whole.load, whole.positions);
  prepared.start = prepared.motion->displacement();
  return prepared;
}

}  // namespace detail

}}  // namespace palpate
