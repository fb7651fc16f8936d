// A quasi-Newton motion of a body under cuts.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/assembly/smoothed_tetrahedra.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/local/mass.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/detail/renewable_factor.hpp>
#include <palpate/model/moving/detail/renewal_thread.hpp>
#include <palpate/model/moving/detail/step_factor.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A body after cuts, for its factor.
struct CutBody {
  DeformableBody body;                     ///< conditions, positions, lumped mass and pattern
  std::function<BlockMatrix()> stiffness;  ///< at rest; called by the thread
  VectorX nodal_mass;               ///< [kg]; the lumped mass has another distribution in elements of second order
  std::vector<NodeId> copied_from;  ///< node from which a node was split, which has a smaller id; or itself
};

/// The factor A of an earlier body, extended to the nodes that cuts have copied since: S A^-1 S^T + D. S gives a copy
/// the displacement of the node that it was split from; D is the inverse of the diagonal block of A on nodes with
/// copies, for their relative displacement. A thread computes the factor of the newest body. `follow` and, once after
/// it, `take_renewed` allocate.
class CutFactor final : public StepFactor {
 public:
  /// `base` is the factor of the body before any cut.
  explicit CutFactor(std::shared_ptr<RenewableFactor> base);

  /// Continues on the body after a cut, whose nodes are those of the last one and new copies.
  void follow(std::shared_ptr<const CutBody> body);
  /// Returns to the body before any cut.
  void restart();

  bool set_mass(double mass) noexcept override;
  void rotate(const VectorX& u, bool stretched = false) noexcept override;
  void solve(const VectorX& r, VectorX& z) noexcept override;
  /// Without the copies.
  void apply(const VectorX& x, VectorX& y) noexcept override;
  bool is_uneven() const noexcept override { return base_->is_uneven(); }
  void take_renewed() noexcept override;
  long renewals() const noexcept override { return renewals_; }

 private:
  void request();
  /// Finds the node of the base of every node, and D.
  void find_base_nodes();
  // In the thread
  void compute() noexcept;
  std::shared_ptr<RenewableFactor> make() const;

  std::shared_ptr<RenewableFactor> base_, whole_;  // the latter: before any cut
  double mass_ = 0.0;
  std::shared_ptr<const CutBody> newest_;  // null: before any cut
  /// What the thread is asked for, and its result; used by the thread while it works.
  struct Request {
    std::shared_ptr<const CutBody> body;
    double mass = 0.0;
    bool wanted = false;  // false after a restart; not used by the thread
    std::shared_ptr<RenewableFactor> made;
  };
  Request request_;
  std::vector<NodeId> base_node_;
  std::vector<NodeId> split_;      // nodes with a copy, and copies
  std::vector<Matrix3> relative_;  // D, for each
  VectorX base_r_, base_z_;
  long renewals_ = 0;
  RenewalThread thread_;  // last: it uses all other members
};

/// The forces of the elements that a cut leaves, evaluated again after every cut.
template <Element E, HyperelasticMaterial M, class S>
class CutForces {
 public:
  /// Whether elements have the ids of the body before any cut.
  static constexpr bool keeps_ids = false;

  /// Those after a cut; `rest` has the elements that are left. Throws as make_energy_forces.
  CutForces after(const CutTopology<E>&, HyperelasticBody<E, M> rest, const SetupLimits& limits) const {
    CutForces made;
    made.made_ = make_energy_forces<S>(std::move(rest), limits);
    return made;
  }
  /// For a motion.
  std::unique_ptr<EnergyForces> take() noexcept { return std::move(made_); }

 private:
  std::unique_ptr<EnergyForces> made_;
};

/// Smoothed tetrahedra: those before the cut, copied and updated. The owner of the forces must outlive it.
template <HyperelasticMaterial M, class S>
class CutForces<Smoothed<Tet4>, M, S> {
 public:
  static constexpr bool keeps_ids = true;
  using Force = SmoothedTetrahedra<M, S>;
  using Owner = BatchedEnergyForces<Force, S>;

  CutForces after(const CutTopology<Smoothed<Tet4>>& topology, HyperelasticBody<Smoothed<Tet4>, M> rest,
                  const SetupLimits& limits) const {
    CutForces made;
    if (used_ == nullptr) {
      made.made_ = std::make_unique<Owner>(Force(rest, limits));
    } else {
      Force force = used_->force();
      force.follow(topology.mesh(), [&](Index e) { return topology.state(e) != ElementState::supported; });
      made.made_ = std::make_unique<Owner>(std::move(force));
    }
    made.used_ = made.made_.get();
    return made;
  }
  std::unique_ptr<EnergyForces> take() noexcept { return std::move(made_); }

 private:
  std::unique_ptr<Owner> made_;
  const Owner* used_ = nullptr;  // null before the first
};

/// A motion whose body follows cuts. Nodes keep their ids, and new ones follow.
template <Element E>
class CutMotion : public TissueMotion {
 public:
  /// Continues on the remaining body of a topology, from the present state; nodes that were split continue with the
  /// state of the node they were split from. Parts without support stay where they are. Allocates. Strong guarantee.
  virtual void follow(const CutTopology<E>& topology) = 0;
  /// Returns to the body before any cut, of this topology; a state must be set then.
  virtual void restart(const CutTopology<E>& whole) = 0;
  /// Present body, for all nodes.
  virtual const CutBody& body() const noexcept = 0;
  /// Number of factors that a thread has computed.
  virtual long renewals() const noexcept = 0;
};

/// Every cut makes a new QuasiNewtonMotion of the remaining elements, with the factor of an earlier body (CutFactor).
/// O(elements) for a cut.
template <Element E, HyperelasticMaterial M, class S>
class CutQuasiNewtonMotion final : public CutMotion<E> {
 public:
  /// `topology` of the body without cuts. Throws as make_motion.
  CutQuasiNewtonMotion(HyperelasticBody<E, M> body, const CutTopology<E>& topology, const Scene& scene,
                       const QuasiNewtonParameters& parameters, const SetupLimits& limits)
      : parameters_(parameters), limits_(limits), body_(std::move(body)) {
    const DeformableBody whole = body_with_mass(body_.rest, scene, limits_);
    prescribed_ = whole.conditions.prescribed;
    load_ = whole.load;
    factor_ = std::make_shared<CutFactor>(std::make_shared<RenewableFactor>(
        whole, assemble_stiffness<E>(body_.rest, limits_), std::vector<NodeId>{}, StiffnessAt(), limits_));
    for (Index e = 0; e < body_.rest.mesh.element_count(); ++e) {
      const auto volumes = lumped_element_mass<E>(element_nodes<E>(body_.rest.mesh, e));
      auto& mass = element_mass_.emplace_back();
      for (int a = 0; a < E::nodes; ++a)
        mass[static_cast<std::size_t>(a)] = body_.rest.density[body_.rest.region_of(e)] * volumes[a];
    }
    restart(topology);
    motion_->begin();
    limits_.threads = 1;  // beside a haptic loop from here on
  }

  void follow(const CutTopology<E>& topology) override {
    std::vector<NodeId> from;  // node whose state a node continues with
    for (NodeId i = 0; i < topology.mesh().node_count(); ++i) {
      NodeId known = i;
      while (3 * Index{known} >= motion_->displacement().size()) known = topology.copied_from(known);
      from.push_back(known);
    }
    VectorX u(3 * topology.mesh().node_count()), v(u.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      set_node_vector(u, static_cast<Index>(i), node_vector(motion_->displacement(), Index{from[i]}));
      set_node_vector(v, static_cast<Index>(i), node_vector(motion_->velocity(), Index{from[i]}));
    }
    make(topology, u);
    motion_->set_state(u, v);
    motion_->shorten_step();
    factor_->follow(cut_);
    was_cut_ = true;
  }
  void restart(const CutTopology<E>& whole) override {
    factor_->restart();
    forces_ = {};
    make(whole, VectorX::Zero(3 * whole.mesh().node_count()));
    motion_->set_load(load_);
    was_cut_ = false;
  }
  const CutBody& body() const noexcept override { return *cut_; }
  long renewals() const noexcept override { return motion_->renewals(); }

  MotionStep step(double h) noexcept override {
    was_cut_ = false;
    MotionStep done = motion_->step(h);
    if (Index& worst = done.deformation.worst_element; worst >= 0 && !forces_.keeps_ids)
      worst = elements_[static_cast<std::size_t>(worst)];
    return done;
  }
  /// Right after a cut there is no step to correct; without inertia the next one forgets it.
  bool correct(const VectorX& more) noexcept override { return was_cut_ ? is_static() : motion_->correct(more); }
  bool set_springs(std::span<const ContactSpring> springs) noexcept override { return motion_->set_springs(springs); }
  bool prepare_response(double h) noexcept override { return motion_->prepare_response(h); }
  bool respond(const VectorX& forces, VectorX& u) noexcept override { return motion_->respond(forces, u); }
  bool respond_here(const VectorX& forces, VectorX& u) noexcept override { return motion_->respond_here(forces, u); }
  bool is_static() const noexcept override { return motion_->is_static(); }
  const VectorX& displacement() const noexcept override { return motion_->displacement(); }
  const VectorX& velocity() const noexcept override { return motion_->velocity(); }
  void rest_at(const VectorX& u) override { motion_->rest_at(u); }
  void set_load(const VectorX& load) override { motion_->set_load(load); }
  /// For the nodes before any cut; copies follow.
  void set_prescribed(const VectorX& values) override {
    require_entries(values, prescribed_.size());
    prescribed_ = values;
    VectorX all = motion_->displacement();
    for (std::size_t i = 0; i < origin_.size(); ++i)
      if (origin_[i] >= 0) set_node_vector(all, static_cast<Index>(i), node_vector(prescribed_, Index{origin_[i]}));
    motion_->set_prescribed(all);
  }

 private:
  /// Makes the motion of the remaining body; nodes without it stay at u.
  void make(const CutTopology<E>& topology, const VectorX& u) {
    auto cut = std::make_shared<CutBody>();
    std::vector<NodeId> origin;
    for (NodeId i = 0; i < topology.mesh().node_count(); ++i) {
      const std::vector<Index>& around = topology.elements_at(i);
      const bool remains = !around.empty() && topology.state(around.front()) == ElementState::supported;
      origin.push_back(remains ? topology.origin_of(i) : NodeId{-1});
      cut->copied_from.push_back(topology.copied_from(i));
    }
    std::vector<Index> elements;
    for (Index e = 0; e < topology.mesh().element_count(); ++e)
      if (topology.state(e) == ElementState::supported) elements.push_back(e);
    HyperelasticBody<E, M> rest = part(topology.mesh(), elements);
    cut->body.conditions = conditions(topology, origin, u);
    cut->body.load = VectorX::Zero(u.size());
    cut->body.lumped = mass_of(topology.mesh(), elements);
    cut->nodal_mass = LinearTetrahedron<E> ? cut->body.lumped : nodal_mass(rest.rest);
    cut->body.pattern = block_pattern(rest.rest.mesh);
    cut->body.positions = rest.rest.mesh.positions;
    cut->stiffness = [own = rest.rest] { return assemble_stiffness<E>(own, SetupLimits{}); };
    DeformableBody body;
    body.conditions = cut->body.conditions;
    body.load = cut->body.load;
    body.lumped = cut->body.lumped;
    body.positions = cut->body.positions;
    CutForces<E, M, S> forces = forces_.after(topology, std::move(rest), limits_);
    // A part of a body has at most the rounding errors of all of it.
    const RoundingErrors* const errors = motion_ ? &motion_->rounding_errors() : nullptr;
    motion_ = std::make_unique<QuasiNewtonMotion>(std::move(body), forces.take(), factor_, parameters_, errors);
    forces_ = std::move(forces);
    cut_ = std::move(cut);
    origin_ = std::move(origin);
    elements_ = std::move(elements);
  }
  /// Lumped mass of elements, which keep their shapes.
  VectorX mass_of(const Mesh<E>& mesh, const std::vector<Index>& elements) const {
    VectorX mass = VectorX::Zero(mesh.node_count());
    for (const Index e : elements)
      for (int a = 0; a < E::nodes; ++a)
        mass[mesh.element_node(e, a)] += element_mass_[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)];
    return mass;
  }
  /// Some elements, with all nodes.
  HyperelasticBody<E, M> part(const Mesh<E>& mesh, const std::vector<Index>& elements) const {
    HyperelasticBody<E, M> made;
    made.rest.elasticity = body_.rest.elasticity;
    made.rest.density = body_.rest.density;
    made.rest.initial_strain = body_.rest.initial_strain;
    made.materials = body_.materials;
    Mesh<E>& of_part = made.rest.mesh;
    of_part.positions = mesh.positions;
    of_part.region_names = mesh.region_names;
    for (const Index e : elements) {
      of_part.elements.push_back(mesh.elements[static_cast<std::size_t>(e)]);
      of_part.regions.push_back(mesh.region(e));
      if (mesh.has_fibres()) of_part.fibres.push_back(mesh.fibre(e));
      if (!body_.rest.materials.empty())
        made.rest.materials.push_back(body_.rest.materials[static_cast<std::size_t>(e)]);
    }
    return made;
  }
  EssentialConditions conditions(const CutTopology<E>& topology, const std::vector<NodeId>& origin,
                                 const VectorX& u) const {
    EssentialConditions made;
    made.prescribed = VectorX::Zero(u.size());
    made.free_index.assign(static_cast<std::size_t>(u.size()), -1);
    for (std::size_t i = 0; i < origin.size(); ++i)
      made.constrained.push_back(origin[i] < 0 ? std::uint8_t{7} : topology.constrained()[i]);
    for (Index dof = 0; dof < u.size(); ++dof) {
      const auto node = static_cast<std::size_t>(dof / 3);
      if ((made.constrained[node] >> (dof % 3) & 1u) != 0) {
        made.prescribed[dof] = origin[node] < 0 ? u[dof] : prescribed_[3 * Index{origin[node]} + dof % 3];
      } else {
        made.free_index[static_cast<std::size_t>(dof)] = made.free_count();
        made.free_dofs.push_back(dof);
      }
    }
    return made;
  }

  QuasiNewtonParameters parameters_;
  SetupLimits limits_;
  HyperelasticBody<E, M> body_;                                                       // before any cut
  VectorX prescribed_, load_;                                                         // of the nodes before any cut
  std::vector<std::array<double, static_cast<std::size_t>(E::nodes)>> element_mass_;  // lumped [kg]
  std::shared_ptr<CutFactor> factor_;
  std::shared_ptr<const CutBody> cut_;
  std::vector<NodeId> origin_;   // node before any cut of every node; -1 without support
  std::vector<Index> elements_;  // that remain
  CutForces<E, M, S> forces_;    // of the motion
  std::unique_ptr<QuasiNewtonMotion> motion_;
  bool was_cut_ = false;  // since the last step
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/cut_motion.ipp>
#endif
