// The static problem of one body: prepared once, loads changed at will.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/assembly/smoothed_strain.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/node_graph.hpp>
#include <palpate/linear/tile.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/mesh/rigid_modes.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/cache_report.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/prepared_system.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/stage_timer.hpp>

#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Stiffness, essential conditions, loads and prepared solver of a body. Neither copied nor moved: the solver refers to
/// its members.
template <Element E, SolverPolicy Policy>
class Statics {
 public:
  using Traits = SolverTraits<Policy>;
  using Stiffness = typename Traits::Assembly::template Operator<E>;
  using System = typename SystemSource<E, Policy>::System;

  /// Prepares everything but the contact. `kept_nodes` are the touchable ones; `cache_file` may hold the prepared
  /// system, or will. Throws what assembly, factorisation and checks throw: unconstrained, not_positive_definite,
  /// ill_conditioned
  /// ... but nothing because of the cache.
  Statics(Body<E> given, const Scene& scene, std::vector<BoundaryFace<E>> boundary,
          const std::vector<NodeId>& kept_nodes, const SetupLimits& limits, const std::string& cache_file,
          SetupReport& report)
      : body_(std::move(given)),
        boundary_(std::move(boundary)),
        conditions_(resolve_essential(body_.mesh, boundary_, scene)) {
    require_constrained(body_.mesh, conditions_.constrained);
    {
      const StageTimer timer(report, "assembly");
      stiffness_ = Traits::Assembly::make(body_, limits);
    }
    const DofLayout dofs = layout(kept_nodes);
    report.kept_dofs = static_cast<Index>(dofs.kept.size());
    const SystemSource<E, Policy> source{body_, conditions_, stiffness_, kept_nodes, dofs, limits};
    system_ = source.prepare(cache_file, report);
    free_load_ = VectorX::Zero(conditions_.free_count());
    free_answer_.resize(conditions_.free_count());
    scratch_ = full_load_ = displacement_ = VectorX::Zero(conditions_.dof_count());
    mass_ = nodal_mass(body_);
    report.stiffness_bytes = stiffness_.bytes();
    report.solver_bytes = system_.bytes();
    report.free_dofs = conditions_.free_count();
    report.condensed_dofs = report.free_dofs - report.kept_dofs;
  }
  Statics(const Statics&) = delete;
  Statics& operator=(const Statics&) = delete;

  /// Loads, prescribed values and initial strains of a scene; `gravity` [m/s^2] in the body's frame. Solves once, and
  /// shows the new displacement to `look`, which may throw, before anything is changed. Strong guarantee.
  template <class Look>
  void set_conditions(const Scene& scene, const Vector3& gravity, Look look) {
    EssentialConditions conditions = resolve_essential(body_.mesh, boundary_, scene);
    if (conditions.constrained != conditions_.constrained)
      raise(SetupErrorKind::unsupported,
            "the new scene prescribes other components than the one the model was made for",
            "Values may change, the set of prescribed components may not: make a new model");
    std::vector<Vector6> strains = initial_strains_by_region(body_.mesh, scene);
    VectorX strain_load = initial_strain_load(body_, strains);
    VectorX applied = applied_load(body_, boundary_, scene);
    Loaded loaded = solve_loads(applied, strain_load, conditions.prescribed, gravity);
    look(std::as_const(loaded.displacement));
    conditions_.prescribed.swap(conditions.prescribed);
    body_.initial_strain.swap(strains);
    strain_load_.swap(strain_load);
    applied_.swap(applied);
    accept(loaded);
  }

  /// Changes gravity [m/s^2], body frame, and solves once; `look` as above. Throws bad_density when some region has
  /// none. Strong guarantee.
  template <class Look>
  void set_gravity(const Vector3& gravity, Look look) {
    Loaded loaded = solve_loads(applied_, strain_load_, conditions_.prescribed, gravity);
    look(std::as_const(loaded.displacement));
    accept(loaded);
  }

  /// Displacement under the scene's loads and `forces` [N] on vertices, 3 per node [m]. No allocation when u has its
  /// size; not to be called by two threads at once.
  template <class Forces>
  SolveReport displacement_with(const Forces& forces, const std::vector<NodeId>& node_of_vertex, VectorX& u) noexcept {
    scratch_.setZero();
    for (const auto& [vertex, force] : forces)
      scratch_.template segment<3>(3 * Index{node_of_vertex[static_cast<std::size_t>(vertex)]}) += force;
    const SolveReport report = solve_free(scratch_, u);
    u += displacement_;
    return report;
  }

  const Body<E>& body() const noexcept { return body_; }
  const std::vector<BoundaryFace<E>>& boundary() const noexcept { return boundary_; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  const VectorX& displacement() const noexcept { return displacement_; }
  /// A solver with a workspace of its own; factors are shared.
  System system() const { return system_; }

  /// K u - f_0: forces with which the body answers, 3 per node [N].
  VectorX internal_force() const {
    VectorX f(displacement_.size());
    stiffness_.apply(displacement_, f);
    return f - strain_load_;
  }
  /// Forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const {
    VectorX r = internal_force() - load_;
    for (Index dof : conditions_.free_dofs) r[dof] = 0.0;
    return r;
  }

 private:
  struct Loaded {
    VectorX load, displacement;
  };

  /// The answer to given loads; nothing is changed but workspaces. Throws bad_density, non_finite or not_converged.
  Loaded solve_loads(const VectorX& applied, const VectorX& strain_load, const VectorX& prescribed,
                     const Vector3& gravity) {
    require_density(gravity);
    Loaded loaded{applied, VectorX(applied.size())};
    for (Index i = 0; i < mass_.size(); ++i) loaded.load.template segment<3>(3 * i) += mass_[i] * gravity;
    stiffness_.apply(prescribed, scratch_);
    full_load_ = loaded.load + strain_load - scratch_;
    const SolveReport solved = solve_free(full_load_, loaded.displacement);
    loaded.displacement += prescribed;
    if (!loaded.displacement.allFinite() || !full_load_.allFinite())
      raise(SetupErrorKind::non_finite, "the static displacement is not finite",
            "Loads may be too large for the stiffness");
    if (!solved.converged)
      raise(SetupErrorKind::not_converged,
            "the static solve stopped at a relative residual of " + number(solved.relative_residual),
            "Use a direct solver");
    return loaded;
  }
  void accept(Loaded& loaded) noexcept {
    load_.swap(loaded.load);
    displacement_.swap(loaded.displacement);
  }

  SolveReport solve_free(const VectorX& load, VectorX& u) noexcept {
    conditions_.gather(load, free_load_);
    const SolveReport report = system_.solve_into(free_load_, free_answer_);
    conditions_.scatter(free_answer_, u);
    return report;
  }

  void require_density(const Vector3& gravity) const {
    if (gravity.isZero(0.0)) return;
    for (std::size_t r = 0; r < body_.density.size(); ++r)
      if (!(body_.density[r] > 0.0))
        raise(SetupErrorKind::bad_density,
              "there is gravity, but region '" + body_.mesh.region_names[r] + "' has no density",
              "Give every region a density in kg/m^3");
  }

  DofLayout layout(const std::vector<NodeId>& kept_nodes) const {
    DofLayout layout{{}, body_.mesh.positions, {}};
    for (NodeId node : kept_nodes)
      for (int c = 0; c < 3; ++c)
        if (const Index free = conditions_.free_index[static_cast<std::size_t>(3 * Index{node} + c)]; free >= 0)
          layout.kept.push_back(free);
    layout.node_of_dof.reserve(conditions_.free_dofs.size());
    for (const Index dof : conditions_.free_dofs) layout.node_of_dof.push_back(dof / 3);
    return layout;
  }

  Body<E> body_;
  std::vector<BoundaryFace<E>> boundary_;
  EssentialConditions conditions_;
  Stiffness stiffness_;
  System system_;
  VectorX mass_, applied_, load_, strain_load_, full_load_, displacement_;
  VectorX free_load_, free_answer_, scratch_;
};

}}  // namespace palpate
