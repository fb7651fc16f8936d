// Definitions of statics.hpp.
#pragma once

#include <palpate/model/static/detail/statics.hpp>

#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Statics::Statics(ElasticBody& body, const Scene& scene, const std::vector<NodeId>& kept_nodes,
                                const MakeStiffness& make_stiffness, const SolverRecipe& recipe,
                                const SetupLimits& limits, const std::string& cache_file, SetupReport& report)
    : body_(&body), conditions_(body_->conditions(scene)) {
  body_->require_constrained(conditions_);
  {
    const StageTimer timer(report, "assembly");
    stiffness_ = make_stiffness(*body_, limits);
  }
  const DofLayout dofs = layout(kept_nodes);
  report.kept_dofs = static_cast<Index>(dofs.kept.size());
  const SystemSource source{recipe, *body_, conditions_, stiffness_, kept_nodes, dofs, limits};
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

PALPATE_INLINE Statics::~Statics() = default;

PALPATE_INLINE void Statics::set_conditions(const Scene& scene, const Vector3& gravity, const Look& look,
                                            const SetupThreads& threads) {
  EssentialConditions conditions = body_->conditions(scene);
  if (conditions.constrained != conditions_.constrained)
    raise(SetupErrorKind::unsupported, "the new scene prescribes other components than the one the model was made for",
          "Values may change, the set of prescribed components may not: make a new model");
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

PALPATE_INLINE void Statics::set_gravity(const Vector3& gravity, const Look& look) {
  Loaded loaded = solve_loads(applied_, strain_load_, conditions_.prescribed, gravity, 1);
  look(loaded.displacement);
  accept(loaded);
}

PALPATE_INLINE SolveReport Statics::displacement_with(std::span<const VertexForce> forces,
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

PALPATE_INLINE VectorX Statics::internal_force() const {
  VectorX f(displacement_.size());
  stiffness_.apply(displacement_, f);
  f -= strain_load_;
  return f;
}

PALPATE_INLINE VectorX Statics::reactions() const {
  VectorX r = internal_force();
  r -= load_;
  for (Index dof : conditions_.free_dofs) r[dof] = 0.0;
  return r;
}

PALPATE_INLINE Statics::Loaded Statics::solve_loads(const VectorX& applied, const VectorX& strain_load,
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

PALPATE_INLINE void Statics::accept(Loaded& loaded) noexcept {
  load_.swap(loaded.load);
  displacement_.swap(loaded.displacement);
}

PALPATE_INLINE SolveReport Statics::solve_free(const VectorX& load, VectorX& u, const SetupThreads& threads) noexcept {
  conditions_.gather(load, free_load_);
  const SolveReport report = system_.solve_into(free_load_, free_answer_, threads);
  conditions_.scatter(free_answer_, u);
  return report;
}

PALPATE_INLINE void Statics::require_density(const Vector3& gravity) const {
  if (gravity.isZero(0.0)) return;
  for (std::size_t r = 0; r < body_->densities().size(); ++r)
    if (!(body_->densities()[r] > 0.0))
      raise(SetupErrorKind::bad_density,
            "there is gravity, but region '" + body_->region_names()[r] + "' has no density",
            "Give every region a density in kg/m^3");
}

PALPATE_INLINE DofLayout Statics::layout(const std::vector<NodeId>& kept_nodes) const {
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
