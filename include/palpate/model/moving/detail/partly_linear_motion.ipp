// Definitions of partly_linear_motion.hpp.
#pragma once

#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/condensation/detail/schur.hpp>
#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/moving/detail/partly_linear_motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE LinearSurroundings::LinearSurroundings(BlockMatrix stiffness, EssentialConditions conditions,
                                                      const std::vector<Vector3>& positions,
                                                      const std::vector<NodeId>& interface_nodes,
                                                      const SetupLimits& limits)
    : stiffness_(std::move(stiffness)), conditions_(std::move(conditions)), is_interface_(positions.size(), 0) {
  for (const NodeId i : interface_nodes) is_interface_[static_cast<std::size_t>(i)] = 1;
  DofLayout layout{{}, positions, {}};
  for (const Index dof : conditions_.free_dofs) {
    layout.node_of_dof.push_back(dof / 3);
    if (is_interface_[static_cast<std::size_t>(dof / 3)] == 0) continue;
    kept_.push_back(dof);
    layout.kept.push_back(conditions_.free_index[static_cast<std::size_t>(dof)]);
  }
  SchurComplement schur = condense(free_matrix(stiffness_, conditions_), layout, limits);
  interior_ = std::move(schur.interior);
  schur_ = std::move(schur.stiffness);
  extension_ = interior_;
  load_ = full_ = zeros(conditions_.dof_count());
  free_ = extended_ = zeros(conditions_.free_count());
  zeros_ = zeros(schur_.rows());
  from_load_ = from_prescribed_ = {full_, zeros_};
  const VectorX values = std::exchange(conditions_.prescribed, full_);
  set_prescribed(values);
}

PALPATE_INLINE bool LinearSurroundings::set_load(const VectorX& load) noexcept {
  bool changed = false;
  for (Index dof = 0; dof < load_.size(); ++dof) {
    const double value = is_interface_[static_cast<std::size_t>(dof / 3)] != 0 ? 0.0 : load[dof];
    changed = changed || value != load_[dof];
    load_[dof] = value;
  }
  if (!changed) return false;
  full_ = load_;
  solve(from_load_);
  return true;
}

PALPATE_INLINE bool LinearSurroundings::set_prescribed(const VectorX& values) noexcept {
  VectorX& own = conditions_.prescribed;
  bool changed = false;
  for (Index dof = 0; dof < own.size(); ++dof) {
    if (!conditions_.is_constrained(dof)) continue;
    changed = changed || own[dof] != values[dof];
    own[dof] = values[dof];
  }
  if (!changed) return false;
  stiffness_.apply(own, full_);
  full_ = -full_;
  solve(from_prescribed_);
  from_prescribed_.displacement += own;
  return true;
}

PALPATE_INLINE void LinearSurroundings::solve(Still& still) noexcept {
  conditions_.gather(full_, free_);
  interior_.eliminate_into(free_, still.kept_load);
  interior_.recover_into(zeros_, free_);
  conditions_.scatter(free_, still.displacement);
}

PALPATE_INLINE void LinearSurroundings::extend(const VectorX& kept, VectorX& u) noexcept {
  extension_.extend_into(kept, extended_);
  conditions_.scatter(extended_, u);
}

/// y = A x; reads the lower half of A, which is symmetric and stored by columns.
PALPATE_INLINE void symmetric_product(const MatrixX& a, const VectorX& x, VectorX& y) noexcept {
  const Index size = x.size();
  fill(y, 0.0);
  for (Index j = 0; j < size; ++j) {
    const double* const column = a.data() + j * size;
    add_scaled(y.data() + j, x[j], column + j, size - j);
    y[j] += dot(column + j + 1, x.data() + j + 1, size - j - 1);
  }
}

PALPATE_INLINE double SurroundedForces::evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept {
  const double stored = part_->evaluate(u, f, report);
  const Index count = stiffness_.rows();
  for (Index i = 0; i < count; ++i) moved_[i] = u[kept_[static_cast<std::size_t>(i)]];
  symmetric_product(stiffness_, moved_, pulled_);
  for (Index i = 0; i < count; ++i) f[kept_[static_cast<std::size_t>(i)]] += pulled_[i];
  return stored + 0.5 * moved_.dot(pulled_);
}

PALPATE_INLINE std::vector<Index> dofs_in(const BodyPart& part, const BodyPart& other, const std::vector<Index>& dofs) {
  std::vector<Index> made;
  for (const Index dof : dofs)
    made.push_back(3 * Index{part.local(other.nodes[static_cast<std::size_t>(dof / 3)])} + dof % 3);
  return made;
}

PALPATE_INLINE SurroundedStiffness::SurroundedStiffness(const BlockPattern& part, const MatrixX& dense,
                                                        const std::vector<Index>& dofs, const SetupLimits& limits) {
  std::vector<NodeId> nodes;
  for (const Index dof : dofs)
    if (const auto node = static_cast<NodeId>(dof / 3); nodes.empty() || nodes.back() != node) nodes.push_back(node);
  BlockPattern joint{{0}, {}};
  auto next = nodes.begin();
  for (Index row = 0; row < part.rows(); ++row) {
    const auto begin = part.column.begin() + part.row_start[static_cast<std::size_t>(row)],
               end = part.column.begin() + part.row_start[static_cast<std::size_t>(row) + 1];
    if (next != nodes.end() && *next == row)
      std::set_union(begin, end, nodes.begin(), ++next, std::back_inserter(joint.column));
    else
      joint.column.insert(joint.column.end(), begin, end);
    joint.row_start.push_back(static_cast<Index>(joint.column.size()));
  }
  surroundings_ = make_stiffness(std::move(joint), limits);
  for (Index row = 0; row < part.rows(); ++row)
    for (Index p = part.row_start[static_cast<std::size_t>(row)]; p <= part.diagonal(row); ++p)
      position_.push_back(pattern().find(static_cast<NodeId>(row), part.column[static_cast<std::size_t>(p)]));
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const auto row = static_cast<NodeId>(dofs[i] / 3), column = static_cast<NodeId>(dofs[j] / 3);
      if (column > row) continue;
      surroundings_.block(pattern().find(row, column))(dofs[i] % 3, dofs[j] % 3) =
          dense(static_cast<Index>(i), static_cast<Index>(j));
    }
}

PALPATE_INLINE void SurroundedStiffness::add_up(const BlockMatrix& part, BlockMatrix& sum) const noexcept {
  sum.copy_values(surroundings_);
  for (std::size_t p = 0; p < position_.size(); ++p) sum.block(position_[p]) += part.block(static_cast<Index>(p));
}

PALPATE_INLINE FarDisplacement::FarDisplacement(const BodyParts& parts, const std::vector<Vector3>& positions,
                                                LinearSurroundings& surroundings, double largest)
    : interface_(parts.interface_nodes), largest_(largest) {
  const auto position = [&](NodeId i) { return positions[static_cast<std::size_t>(i)]; };
  Vector3 centre = Vector3::Zero();
  for (const NodeId i : interface_) centre += position(i) / static_cast<double>(interface_.size());
  Matrix3 inertia = Matrix3::Zero();
  for (const NodeId i : interface_) {
    const Vector3 r = arm_.emplace_back(position(i) - centre);
    inertia += r.squaredNorm() * Matrix3::Identity() - r * r.transpose();
  }
  if (inertia.trace() > 0.0)  // the second term: nodes on a line do not show a rotation about it
    inverse_inertia_ = (inertia + 1e-6 * inertia.trace() * Matrix3::Identity()).inverse();
  const std::vector<Index>& kept = surroundings.kept();
  VectorX rotated(static_cast<Index>(kept.size())),
      far_displacement(3 * static_cast<Index>(parts.far_part.nodes.size()));
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const NodeId node = parts.far_part.nodes[static_cast<std::size_t>(kept[k] / 3)];
      rotated[static_cast<Index>(k)] = Vector3::Unit(axis).cross(position(node) - centre)[kept[k] % 3];
    }
    far_displacement.setZero();
    surroundings.extend(rotated, far_displacement);
    for (Index i = 0; i < far_displacement.size() / 3; ++i)
      reach_[axis] = std::max(reach_[axis], node_vector(far_displacement, i).norm());
  }
  const std::vector<std::uint8_t>& constrained = surroundings.conditions().constrained;
  for (std::size_t i = 0; i < constrained.size(); ++i)
    if (constrained[i] != 0 && !surroundings.is_interface(i))
      supports_.push_back({parts.far_part.nodes[i], constrained[i]});
  displaced_.resize(interface_.size() + supports_.size());
  loaded_.resize(constrained.size());
}

PALPATE_INLINE void FarDisplacement::set_from_load(const VectorX& u) noexcept {
  for (std::size_t i = 0; i < loaded_.size(); ++i) loaded_[i] = node_vector(u, static_cast<Index>(i));
  loads_displace_ = !(displacement_spread(loaded_) <= largest_);
}

PALPATE_INLINE bool FarDisplacement::is_too_large(const VectorX& u) noexcept {
  if (loads_displace_) return true;
  Vector3 mean = Vector3::Zero(), moment = Vector3::Zero();
  std::size_t next = 0;
  for (const NodeId i : interface_) {
    const Vector3& moved = displaced_[next] = node_vector(u, Index{i});
    mean += moved / static_cast<double>(interface_.size());
    moment += arm_[next++].cross(moved);
  }
  for (const Support& support : supports_) {
    displaced_[next] = mean;
    for (int c = 0; c < 3; ++c)
      if ((support.constrained >> c & 1u) != 0) displaced_[next][c] = u[3 * Index{support.node} + c];
    ++next;
  }
  const Vector3 rotation = inverse_inertia_ * moment;
  return !(displacement_spread(displaced_) <= largest_) || !(rotation.cwiseAbs().dot(reach_) <= largest_);
}

PALPATE_INLINE PartlyLinearMotion::PartlyLinearMotion(BodyParts parts, std::unique_ptr<TissueMotion> near_motion,
                                                      std::unique_ptr<LinearSurroundings> surroundings,
                                                      const VectorX& load, const std::vector<Vector3>& positions)
    : parts_(std::move(parts)),
      surroundings_(std::move(surroundings)),
      near_(std::move(near_motion)),
      kept_(dofs_in(parts_.near_part, parts_.far_part, surroundings_->kept())),
      far_displacement_(parts_, positions, *surroundings_, largest_linear_displacement * extent(positions)),
      u_(zeros(load.size())),
      v_(u_),
      load_(load),
      near_vector_(zeros(near_->displacement().size())),
      far_vector_(zeros(3 * static_cast<Index>(parts_.far_part.nodes.size()))),
      kept_moved_(zeros(static_cast<Index>(kept_.size()))),
      extended_(far_vector_) {
  for (const Index dof : kept_)
    kept_in_body_.push_back(3 * Index{parts_.near_part.nodes[static_cast<std::size_t>(dof / 3)]} + dof % 3);
  set_load(load);
  far_displacement_.set_from_load(surroundings_->from_load().displacement);
  springs_.reserve(most_springs);
  take_displacement();
}

PALPATE_INLINE MotionStep PartlyLinearMotion::step(double h) noexcept {
  MotionStep done = near_->step(h);
  if (Index& worst = done.deformation.worst_element; worst >= 0)
    worst = parts_.near_part.elements[static_cast<std::size_t>(worst)];
  stepped_ = done.taken;
  if (!done.taken) return done;
  take_displacement();
  if (far_displacement_.is_too_large(u_)) done.status.set(StatusFlag::large_displacement);
  return done;
}

PALPATE_INLINE bool PartlyLinearMotion::set_springs(std::span<const ContactSpring> springs) noexcept {
  copy_springs(springs, springs_);
  for (ContactSpring& s : springs_)
    for (NodeId& node : s.nodes) node = parts_.near_part.local(node);
  return near_->set_springs(springs_);
}

PALPATE_INLINE void PartlyLinearMotion::take_displacement() noexcept {
  if (std::exchange(far_changed_, false)) {
    far_vector_ = surroundings_->from_load().displacement + surroundings_->from_prescribed().displacement;
    parts_.far_part.scatter(far_vector_, u_);
  }
  parts_.near_part.scatter(near_->displacement(), u_);
}

PALPATE_INLINE void PartlyLinearMotion::complete(VectorX& u) noexcept {
  for (std::size_t i = 0; i < kept_.size(); ++i) kept_moved_[static_cast<Index>(i)] = u[kept_in_body_[i]];
  surroundings_->extend(kept_moved_, extended_);
  for (std::size_t i = 0; i < parts_.far_part.nodes.size(); ++i)
    if (!surroundings_->is_interface(i))
      add_node_vector(u, Index{parts_.far_part.nodes[i]}, node_vector(extended_, static_cast<Index>(i)));
}

PALPATE_INLINE bool PartlyLinearMotion::respond(const VectorX& forces, VectorX& u) noexcept {
  parts_.near_part.gather(forces, near_vector_);
  if (!near_->respond(near_vector_, near_vector_)) return false;
  fill(u, 0.0);
  parts_.near_part.scatter(near_vector_, u);
  return true;
}

PALPATE_INLINE void PartlyLinearMotion::rest_at(const VectorX& u) {
  require_entries(u, u_.size());
  parts_.near_part.gather(u, near_vector_);
  near_->rest_at(near_vector_);
  stepped_ = false;
  take_displacement();
}

PALPATE_INLINE void PartlyLinearMotion::set_load(const VectorX& load) {
  require_entries(load, u_.size());
  load_ = load;
  parts_.far_part.gather(load, far_vector_);
  if (surroundings_->set_load(far_vector_)) {
    far_displacement_.set_from_load(surroundings_->from_load().displacement);
    far_changed_ = true;
  }
  load_near();
}

PALPATE_INLINE void PartlyLinearMotion::set_prescribed(const VectorX& values) {
  require_entries(values, u_.size());
  parts_.far_part.gather(values, far_vector_);
  far_changed_ = surroundings_->set_prescribed(far_vector_) || far_changed_;
  parts_.near_part.gather(values, near_vector_);
  near_->set_prescribed(near_vector_);
  load_near();
}

PALPATE_INLINE void PartlyLinearMotion::load_near() noexcept {
  parts_.near_part.gather(load_, near_vector_);
  for (std::size_t i = 0; i < kept_.size(); ++i)
    near_vector_[kept_[i]] += surroundings_->kept_load(static_cast<Index>(i));
  near_->set_load(near_vector_);
}

PALPATE_INLINE PreparedMotion prepare_partly_linear(DeformableBody whole, BodyParts parts,
                                                    const BlockPattern& near_pattern, const BlockMatrix& near_stiffness,
                                                    StiffnessAt near_stiffness_at,
                                                    std::unique_ptr<EnergyForces> near_forces,
                                                    std::unique_ptr<LinearSurroundings> surroundings,
                                                    const QuasiNewtonParameters& parameters,
                                                    const SetupLimits& limits) {
  const std::vector<Index> kept = dofs_in(parts.near_part, parts.far_part, surroundings->kept());
  DeformableBody near_body;
  near_body.conditions = conditions_of(parts.near_part, whole.conditions);
  near_body.pattern = near_pattern;
  near_body.load = zeros(near_body.conditions.dof_count());
  parts.near_part.gather(whole.load, near_body.load);
  near_body.lumped = zeros(static_cast<Index>(parts.near_part.nodes.size()));
  for (std::size_t i = 0; i < parts.near_part.nodes.size(); ++i) {
    near_body.lumped[static_cast<Index>(i)] = whole.lumped[parts.near_part.nodes[i]];
    near_body.positions.push_back(whole.positions[static_cast<std::size_t>(parts.near_part.nodes[i])]);
  }
  VectorX far_load = zeros(3 * static_cast<Index>(parts.far_part.nodes.size()));
  parts.far_part.gather(whole.load, far_load);
  surroundings->set_load(far_load);
  for (std::size_t i = 0; i < kept.size(); ++i)
    near_body.load[kept[i]] += surroundings->kept_load(static_cast<Index>(i));

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
  auto factor = std::make_shared<RenewableFactor>(near_body, std::move(stiffness), parts.interface_in(parts.near_part),
                                                  std::move(stiffness_at), limits);
  auto motion = std::make_unique<QuasiNewtonMotion>(
      std::move(near_body), std::make_unique<SurroundedForces>(std::move(near_forces), surroundings->stiffness(), kept),
      std::move(factor), parameters);
  motion->begin();
  PreparedMotion prepared;
  prepared.large_strain = true;
  prepared.motion = std::make_unique<PartlyLinearMotion>(std::move(parts), std::move(motion), std::move(surroundings),
                                                         whole.load, whole.positions);
  prepared.start = prepared.motion->displacement();
  return prepared;
}

}}}  // namespace palpate::detail
