// The static problem of one body: prepared once, loads changed at will.
#pragma once

#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/concepts/linear_solver.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/static/detail/prepared_system.hpp>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Stiffness, essential conditions, loads and prepared solver of a body, which it refers to. Neither copied nor moved:
/// the solver refers to its members.
class Statics {
 public:
  using MakeStiffness = std::function<AnyStiffness(const ElasticBody&, const SetupLimits&)>;
  /// Sees a displacement before it is accepted, 3 per node [m]; may throw.
  using Look = std::function<void(const VectorX&)>;

  /// Prepares everything but the contact. `kept_nodes` are the touchable ones; `cache_file` may hold the prepared
  /// system, or will. Throws what assembly, factorisation and checks throw: unconstrained, not_positive_definite,
  /// ill_conditioned ... but nothing because of the cache.
  Statics(ElasticBody& body, const Scene& scene, const std::vector<NodeId>& kept_nodes,
          const MakeStiffness& make_stiffness, const SolverRecipe& recipe, const SetupLimits& limits,
          const std::string& cache_file, SetupReport& report);
  Statics(const Statics&) = delete;
  Statics& operator=(const Statics&) = delete;
  ~Statics();

  /// Loads, prescribed values and initial strains of a scene; `gravity` [m/s^2] in the body's frame. Solves once, and
  /// shows the new displacement to `look` before anything is changed. Strong guarantee.
  void set_conditions(const Scene& scene, const Vector3& gravity, const Look& look);

  /// Changes gravity [m/s^2], body frame, and solves once; `look` as above. Throws bad_density when some region has
  /// none. Strong guarantee.
  void set_gravity(const Vector3& gravity, const Look& look);

  /// Displacement under the scene's loads and `forces` [N] on vertices, 3 per node [m]. Resizes u when it has another
  /// size, which allocates; otherwise it does not. A force on a vertex that does not exist is left out, and the report
  /// says not converged, with a residual of infinity. Not to be called by two threads at once.
  SolveReport displacement_with(std::span<const VertexForce> forces, const std::vector<NodeId>& node_of_vertex,
                                VectorX& u) noexcept;

  const ElasticBody& body() const noexcept { return *body_; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  const VectorX& displacement() const noexcept { return displacement_; }
  /// A solver with a workspace of its own; factors are shared.
  AnyStaticSystem system() const { return system_; }

  /// K u - f_0: forces with which the body answers, 3 per node [N].
  VectorX internal_force() const;
  /// Forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const;

 private:
  struct Loaded {
    VectorX load, displacement;
  };

  /// The answer to given loads; nothing is changed but workspaces. Throws bad_density, non_finite or not_converged.
  Loaded solve_loads(const VectorX& applied, const VectorX& strain_load, const VectorX& prescribed,
                     const Vector3& gravity);
  void accept(Loaded& loaded) noexcept;
  SolveReport solve_free(const VectorX& load, VectorX& u) noexcept;
  void require_density(const Vector3& gravity) const;
  DofLayout layout(const std::vector<NodeId>& kept_nodes) const;

  ElasticBody* body_;
  EssentialConditions conditions_;
  AnyStiffness stiffness_;
  AnyStaticSystem system_;
  VectorX mass_, applied_, load_, strain_load_, full_load_, displacement_;
  VectorX free_load_, free_answer_, scratch_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/statics.ipp>
#endif
