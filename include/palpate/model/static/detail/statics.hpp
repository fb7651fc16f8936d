// The static problem of one body: prepared once, loads can be changed any number of times.
#pragma once

#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/concepts/linear_solver.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/cache/cache_file.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>
#include <palpate/model/static/detail/prepared_system.hpp>

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Stiffness, essential conditions, loads and prepared solver of a body; keeps a reference to the body. Neither
/// copyable nor movable, because the solver refers to members.
class Statics {
 public:
  using MakeStiffness = std::function<detail::AnyStiffness(const ElasticBody&, const SetupLimits&)>;
  /// Receives a displacement, 3 per node [m], before it is accepted; may throw.
  using Look = std::function<void(const VectorX&)>;

  /// Prepares everything except the contact. `kept_nodes` are the touchable nodes; the prepared system is read from or
  /// stored in `cache_file`. Throws the errors of assembly, factorisation and checks: unconstrained,
  /// not_positive_definite, ill_conditioned ...; cache problems never throw.
  Statics(ElasticBody& body, const Scene& scene, const std::vector<NodeId>& kept_nodes,
          const MakeStiffness& make_stiffness, const detail::SolverRecipe& recipe, const SetupLimits& limits,
          const CacheFile& cache_file, SetupReport& report);
  Statics(const Statics&) = delete;
  Statics& operator=(const Statics&) = delete;

  /// Sets loads, prescribed values and initial strains of a scene; `gravity` [m/s^2] in the body frame. Solves once,
  /// and passes the new displacement to `look` before anything is changed. `threads` are those of a set-up. Strong
  /// guarantee.
  void set_conditions(const Scene& scene, const Vector3& gravity, const Look& look, const SetupThreads& threads = 1);

  /// Changes gravity [m/s^2], body frame, and solves once; `look` as above. Throws bad_density when a region has no
  /// density. Strong guarantee.
  void set_gravity(const Vector3& gravity, const Look& look) {
    Loaded loaded = solve_loads(applied_, strain_load_, conditions_.prescribed, gravity, 1);
    look(loaded.displacement);
    accept(loaded);
  }

  /// Displacement under the scene's loads and `forces` [N] on vertices, 3 per node [m]. Allocates only to resize u when
  /// it has another size. A force on a vertex that does not exist is ignored, and the report states not converged, with
  /// a residual of infinity. Not to be called by two threads simultaneously.
  SolveReport displacement_with(std::span<const VertexForce> forces, const std::vector<NodeId>& node_of_vertex,
                                VectorX& u) noexcept;

  const ElasticBody& body() const noexcept { return *body_; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  const VectorX& displacement() const noexcept { return displacement_; }
  /// A copy of the solver with its own workspace; factors are shared.
  detail::AnyStaticSystem system() const { return system_; }

  /// Internal force K u - f_0, 3 per node [N].
  VectorX internal_force() const;
  /// Reaction forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const;

 private:
  struct Loaded {
    VectorX load, displacement;
  };

  /// Solution for given loads; changes only workspaces. Throws bad_density, non_finite or not_converged.
  Loaded solve_loads(const VectorX& applied, const VectorX& strain_load, const VectorX& prescribed,
                     const Vector3& gravity, const SetupThreads& threads);
  void accept(Loaded& loaded) noexcept {
    load_.swap(loaded.load);
    displacement_.swap(loaded.displacement);
  }
  SolveReport solve_free(const VectorX& load, VectorX& u, const SetupThreads& threads) noexcept;
  void require_density(const Vector3& gravity) const;
  DofLayout layout(const std::vector<NodeId>& kept_nodes) const;

  ElasticBody* body_;
  EssentialConditions conditions_;
  detail::AnyStiffness stiffness_;
  detail::AnyStaticSystem system_;
  VectorX mass_, applied_, load_, strain_load_, full_load_, displacement_;
  VectorX free_load_, free_answer_, scratch_;
};

inline Statics::Statics(ElasticBody& body, const Scene& scene, const std::vector<NodeId>& kept_nodes,
                        const MakeStiffness& make_stiffness, const detail::SolverRecipe& recipe,
                        const SetupLimits& limits, const CacheFile& cache_file, SetupReport& report)
    : body_(&body), conditions_(body_->conditions(scene)) {
  body_->require_constrained(conditions_);
  {
    const detail::StageTimer timer(report, "assembly");
    stiffness_ = make_stiffness(*body_, limits);
  }
  const DofLayout dofs = layout(kept_nodes);
  report.kept_dofs = static_cast<Index>(dofs.kept.size());
  const detail::SystemSource source{recipe, *body_, conditions_, stiffness_, kept_nodes, dofs, limits};
  system_ = source.prepare(cache_file, report);
  free_load_ = VectorX::Zero(conditions_.free_count());
  free_answer_.resize(conditions_.free_count());
  scratch_ = full_load_ = displacement_ = VectorX::Zero(conditions_.dof_count());
  mass_ = body_->nodal_mass();
  report.stiffness_bytes = stiffness_.bytes();
  report.solver_bytes = system_.bytes();
  report.free_dofs = conditions_.free_count();
  report.condensed_dofs = report.free_dofs - report.kept_dofs;
}

inline void Statics::set_conditions(const Scene& scene, const Vector3& gravity, const Look& look,
                                    const SetupThreads& threads) {
  EssentialConditions conditions = body_->conditions(scene);
  conditions.require_components(conditions_);
  std::vector<Vector6> strains = body_->initial_strains(scene);
  VectorX strain_load = body_->initial_strain_load(strains);
  VectorX applied = body_->applied_load(scene);
  Loaded loaded = solve_loads(applied, strain_load, conditions.prescribed, gravity, threads);
  look(loaded.displacement);
  conditions_.prescribed.swap(conditions.prescribed);
  body_->swap_initial_strains(strains);
  strain_load_.swap(strain_load);
  applied_.swap(applied);
  accept(loaded);
}

inline SolveReport Statics::displacement_with(std::span<const VertexForce> forces,
                                              const std::vector<NodeId>& node_of_vertex, VectorX& u) noexcept {
  if (u.size() != displacement_.size()) u.resize(displacement_.size());
  bool all_exist = true;
  scratch_.setZero();
  for (const auto& [vertex, force] : forces)
    if (vertex >= 0 && static_cast<std::size_t>(vertex) < node_of_vertex.size())
      add_node_vector(scratch_, node_of_vertex[static_cast<std::size_t>(vertex)], force.in_model_axes());
    else
      all_exist = false;
  SolveReport report = solve_free(scratch_, u, 1);
  u += displacement_;
  if (!all_exist) {
    report.converged = false;
    report.relative_residual = infinity;
  }
  return report;
}

inline VectorX Statics::internal_force() const {
  VectorX f(displacement_.size());
  stiffness_.apply(displacement_, f);
  f -= strain_load_;
  return f;
}

inline VectorX Statics::reactions() const {
  VectorX r = internal_force();
  r -= load_;
  for (Index dof : conditions_.free_dofs) r[dof] = 0.0;
  return r;
}

inline Statics::Loaded Statics::solve_loads(const VectorX& applied, const VectorX& strain_load,
                                            const VectorX& prescribed, const Vector3& gravity,
                                            const SetupThreads& threads) {
  require_density(gravity);
  Loaded loaded{applied, VectorX(applied.size())};
  for (Index i = 0; i < mass_.size(); ++i) add_node_vector(loaded.load, i, mass_[i] * gravity);
  stiffness_.apply(prescribed, scratch_);
  full_load_ = loaded.load;
  full_load_ += strain_load;
  full_load_ -= scratch_;
  const SolveReport solved = solve_free(full_load_, loaded.displacement, threads);
  loaded.displacement += prescribed;
  if (!all_finite(loaded.displacement) || !all_finite(full_load_))
    raise(SetupErrorKind::non_finite, "the static displacement is not finite",
          "Loads may be too large for the stiffness");
  if (!solved.converged)
    raise(SetupErrorKind::not_converged,
          "the static solve stopped at a relative residual of " + number(solved.relative_residual),
          "Use a direct solver");
  return loaded;
}

inline SolveReport Statics::solve_free(const VectorX& load, VectorX& u, const SetupThreads& threads) noexcept {
  conditions_.gather(load, free_load_);
  const SolveReport report = system_.solve_into(free_load_, free_answer_, threads);
  conditions_.scatter(free_answer_, u);
  return report;
}

inline void Statics::require_density(const Vector3& gravity) const {
  if (gravity.isZero(0.0)) return;
  for (std::size_t r = 0; r < body_->densities().size(); ++r)
    if (!(body_->densities()[r] > 0.0))
      raise(SetupErrorKind::bad_density,
            "there is gravity, but region '" + body_->region_names()[r] + "' has no density",
            "Give every region a density in kg/m^3");
}

inline DofLayout Statics::layout(const std::vector<NodeId>& kept_nodes) const {
  DofLayout layout{{}, body_->positions(), {}};
  for (NodeId node : kept_nodes)
    for (int c = 0; c < 3; ++c)
      if (const Index free = conditions_.free_index[static_cast<std::size_t>(3 * Index{node} + c)]; free >= 0)
        layout.kept.push_back(free);
  layout.node_of_dof.reserve(conditions_.free_dofs.size());
  for (const Index dof : conditions_.free_dofs) layout.node_of_dof.push_back(dof / 3);
  return layout;
}

}}  // namespace palpate
