// The static problem of one body: prepared once, loads can be changed any number of times.
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

/// Stiffness, essential conditions, loads and prepared solver of a body; keeps a reference to the body. Neither
/// copyable nor movable, because the solver refers to members.
class Statics {
 public:
  using MakeStiffness = std::function<AnyStiffness(const ElasticBody&, const SetupLimits&)>;
  /// Receives a displacement, 3 per node [m], before it is accepted; may throw.
  using Look = std::function<void(const VectorX&)>;

  /// Prepares everything except the contact. `kept_nodes` are the touchable nodes; the prepared system is read from or
  /// stored in `cache_file`. Throws the errors of assembly, factorisation and checks: unconstrained,
  /// not_positive_definite, ill_conditioned ...; cache problems never throw.
  Statics(ElasticBody& body, const Scene& scene, const std::vector<NodeId>& kept_nodes,
          const MakeStiffness& make_stiffness, const SolverRecipe& recipe, const SetupLimits& limits,
          const std::string& cache_file, SetupReport& report);
  Statics(const Statics&) = delete;
  Statics& operator=(const Statics&) = delete;
  ~Statics();

  /// Sets loads, prescribed values and initial strains of a scene; `gravity` [m/s^2] in the body frame. Solves once,
  /// and passes the new displacement to `look` before anything is changed. `threads` are those of a set-up. Strong
  /// guarantee.
  void set_conditions(const Scene& scene, const Vector3& gravity, const Look& look, const SetupThreads& threads = 1);

  /// Changes gravity [m/s^2], body frame, and solves once; `look` as above. Throws bad_density when a region has no
  /// density. Strong guarantee.
  void set_gravity(const Vector3& gravity, const Look& look);

  /// Displacement under the scene's loads and `forces` [N] on vertices, 3 per node [m]. Allocates only to resize u when
  /// it has another size. A force on a vertex that does not exist is ignored, and the report states not converged, with
  /// a residual of infinity. Not to be called by two threads simultaneously.
  SolveReport displacement_with(std::span<const VertexForce> forces, const std::vector<NodeId>& node_of_vertex,
                                VectorX& u) noexcept;

  const ElasticBody& body() const noexcept { return *body_; }
  const EssentialConditions& conditions() const noexcept { return conditions_; }
  const VectorX& displacement() const noexcept { return displacement_; }
  /// A copy of the solver with its own workspace; factors are shared.
  AnyStaticSystem system() const { return system_; }

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
  void accept(Loaded& loaded) noexcept;
  SolveReport solve_free(const VectorX& load, VectorX& u, const SetupThreads& threads) noexcept;
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
