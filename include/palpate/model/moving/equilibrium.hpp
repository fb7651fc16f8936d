// Static equilibrium at large deformation, by Newton's method along a path of loads.
#pragma once

#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/newton.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/detail/mechanisms.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

struct EquilibriumParameters {
  NewtonParameters newton{};
  int load_steps = 1;           ///< to start with; a step that fails is halved, one that is easy doubled
  double smallest_step = 1e-4;  ///< of the loads; a smaller one gives up
};

/// What a caller may decide about how a body is made from a mesh.
struct EquilibriumOptions {
  AdmissionPolicy admission{};
  SetupLimits limits{};
};

struct EquilibriumReport {
  bool converged = false;
  int load_steps = 0, iterations = 0, refused_steps = 0;
  double fraction = 0.0;            ///< of the loads that are in equilibrium
  double relative_residual = 0.0;   ///< of the last step
  bool stable = true;               ///< the tangent stiffness is positive definite there
  DeformationReport deformation{};  ///< ids of elements are those of the mesh as given
};

/// What was reached, in a sentence.
std::string describe(const EquilibriumReport& r);

/// A body under dead loads and prescribed displacements, at rest or so slow that inertia does not count. Neither copied
/// nor moved.
class Equilibrium {
 public:
  /// Admits the mesh as other tissues do, with one material everywhere or one per region: hyperelastic, linear, or with
  /// memory. Throws what admit, make_deformable_body and conditions throw, and unconstrained; ids are those of the mesh
  /// as given. Vectors have the nodes of the admitted mesh, see `node_map`.
  template <Element E, Material M>
  Equilibrium(const Mesh<E>& mesh, const Scene& scene, const M& material, const EquilibriumOptions& options = {})
      : Equilibrium(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}
  template <Element E, Material M>
  Equilibrium(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
              const EquilibriumOptions& options = {})
      : Equilibrium(prepare(mesh, scene, materials, options), options.limits) {}
  /// Of a mesh that has been admitted; its geometry is not checked. Throws what make_deformable_body throws, and
  /// unconstrained.
  template <Element E, LargeStrainMaterial M>
  Equilibrium(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {})
      : Equilibrium(make_constrained_body(std::move(body), scene, limits), limits) {}
  /// A body that is held, with or without mass, at any strain, of a mesh that has been admitted.
  explicit Equilibrium(DeformableBody body, const SetupLimits& limits = {});
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Raises the loads from none to all. What is reached at the end is in `displacement()`. A body with memory is held
  /// there until nothing fades any more. Throws bad_argument for parameters that cannot be.
  EquilibriumReport solve(const EquilibriumParameters& parameters = {});

  /// Lets dt >= 0 seconds pass, at the end of which loads and prescribed values are as they are set: relaxation and
  /// creep without inertia. dt = 0 is a sudden change. Where no equilibrium is found nothing has changed. Throws
  /// bad_argument.
  EquilibriumReport step(double dt, const EquilibriumParameters& parameters = {});

  /// Dead loads from the next `solve` or `step` on [N]. Throws bad_argument for another size.
  void set_load(const VectorX& load);
  /// Values of the prescribed components at the end of the next `solve` or `step` [m]. Throws as set_load.
  void set_prescribed(const VectorX& values);

  /// New id of every node as given, -1 for those dropped at admission. Empty when the body was given ready made.
  const std::vector<NodeId>& node_map() const noexcept { return node_map_; }
  const EssentialConditions& conditions() const noexcept { return body_.conditions; }
  const VectorX& displacement() const noexcept { return displacement_; }
  double energy() const noexcept { return body_.elastic->energy(displacement_); }
  VectorX internal_force() const;
  /// Forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const;
  /// Gives the body away. Nothing else may be called after it. Positions of a body made from a mesh are relative to the
  /// centre of its box.
  DeformableBody release() &&;

  // NewtonProblem, at the present loads
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept;
  bool prepare(const VectorX& x) noexcept;
  void direction(const VectorX& residual, VectorX& d) noexcept;
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept { return rounding_; }

 private:
  struct Prepared {
    DeformableBody body;
    OriginalIds ids;
    std::vector<NodeId> node_map;
  };

  template <Element E, Material M>
  static Prepared prepare(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                          const EquilibriumOptions& options) {
    Admitted<E> admitted = admit<E>(mesh, options.admission);
    Prepared prepared{{}, original_ids(admitted), std::move(admitted.node_map)};
    const ScopedIdTranslation translation(prepared.ids);
    const Vector3 origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
    for (Vector3& x : admitted.mesh.positions) x -= origin;
    const Scene mapped = scene.mapped(prepared.node_map, origin);
    require_constrained(admitted.mesh,
                        resolve_essential(admitted.mesh, extract_boundary<E>(admitted.mesh), mapped).constrained,
                        origin);
    prepared.body =
        make_constrained_body(detail::make_any_body(std::move(admitted.mesh), materials), mapped, options.limits);
    return prepared;
  }
  Equilibrium(Prepared prepared, const SetupLimits& limits);
  Equilibrium(Prepared& prepared, const SetupLimits& limits, const ScopedIdTranslation&);

  static void require_usable(const EquilibriumParameters& p);

  void end() noexcept;

  /// From the loads and held values at the start to those that are set, in steps that adapt.
  EquilibriumReport follow_loads(const EquilibriumParameters& parameters);

  /// Sets loads and held values to a fraction of the way.
  void go(double fraction) noexcept;
  /// Full displacement from the free dofs, with the present held values.
  void place(const VectorX& x) noexcept { body_.conditions.place(x, prescribed_, displacement_); }

  /// From equilibrium at the present loads to equilibrium at another fraction: a step along the tangent, then Newton's
  /// method.
  NewtonReport advance(NewtonMethod& newton, double to) noexcept;

  /// Where the tangent is not positive definite the state may be an unstable equilibrium, which the residual alone does
  /// not leave (a column pressed straight): adds the direction of most negative curvature, by inverse iteration.
  void add_descent_direction(const VectorX& residual, VectorX& d) noexcept;

  OriginalIds ids_;
  std::vector<NodeId> node_map_;
  DeformableBody body_;
  TangentSolver tangent_;
  VectorX displacement_, force_, full_, prescribed_, load_, from_prescribed_, from_load_;
  VectorX x_, start_, residual_, direction_, buckling_, trial_;
  bool stepped_ = false;  // displacement_ is the end of a step
  double scale_ = 0.0, size_ = 0.0, rounding_ = 0.0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/equilibrium.ipp>
#endif
