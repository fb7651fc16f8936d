// Static equilibrium at large deformation by Newton's method with load steps.
#pragma once

#include <palpate/assembly/essential_conditions.hpp>
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
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Minimises a potential by proximal steps (Rockafellar 1976), which are steps of implicit Euler along its gradient:
/// each minimises potential + s/2 |x - c|^2, c the end of the last step, by Newton's method without a line search. In a
/// slender body the potential is a narrow curved valley. A line search allows short steps only, because every straight
/// step stretches the body; here the next iteration removes the stretch, and s keeps the step within bounds. With s
/// above the most negative curvature, steps grow away from an unstable equilibrium; s is halved and more while few
/// iterations suffice, so that the last steps are Newton's.
///
/// The problem is a NewtonProblem with two more functions: assemble(x), which sets the matrix of `tangent`, and
/// extent(), the size of the body [m]. Only the constructor allocates.
class ProximalDescent {
 public:
  ProximalDescent(detail::TangentSolver& tangent, Index size);

  /// Forgets the softest mode, from which a run starts.
  void forget() noexcept;

  /// Moves x to a minimum of the potential, to the tolerance of the relative residual. Takes at most `most`
  /// factorisations (and up to 10 more that end a step), which are added to `count`. False: x is not a minimum.
  template <class Problem>
  bool run(Problem& problem, VectorX& x, double tolerance, int most, int& count) noexcept {
    most += count;
    double lowest = problem.evaluate(x, residual_), s = 0.0;
    problem.assemble(x);
    if (!(lowest < infinity) || !find_shift(s, count)) return false;
    centre_ = x;
    if (residual_.norm() <= 1e-3 * problem.scale()) {
      if (!leave(problem)) return false;
      lowest = infinity;
    }
    bool refused = false;
    while (count < most) {
      int iterations = 0;
      x = centre_;
      const double reached = minimise(problem, x, s, iterations) ? problem.evaluate(x, residual_) : infinity;
      count += std::max(1, iterations);
      const bool taken = reached < infinity && reached - lowest <= 1e-9 * std::abs(reached);
      if (taken) {
        lowest = reached;
        centre_ = x;
        if (residual_.norm() <= std::max(tolerance * problem.scale(), problem.rounding())) return true;
      }
      if (!taken)
        s *= 2.0;
      else if (!refused)
        s *= iterations <= 4 ? 1.0 / 16.0 : iterations <= 8 ? 0.25 : 0.5;
      refused = !taken;
    }
    return false;
  }

 private:
  /// Factorises the assembled matrix with a shift of about twice its most negative curvature. mode_ becomes the mode of
  /// that curvature.
  bool find_shift(double& shift, int& count) noexcept;
  /// Curvature of mode_ after some steps of inverse iteration with the factor.
  double soften() noexcept;

  /// Displaces centre_ along mode_, downhill if there is a slope.
  template <class Problem>
  bool leave(Problem& problem) noexcept {
    double length = std::copysign(0.02 * problem.extent() / mode_.cwiseAbs().maxCoeff(), residual_.dot(mode_));
    for (int k = 0; k < 10; ++k, length *= 0.5) {
      step_ = centre_ + length * mode_;
      if (!(problem.evaluate(step_, residual_) < infinity)) continue;
      centre_ = step_;
      return true;
    }
    return false;
  }

  /// Newton's method for potential + s/2 |x - centre_|^2, until a tenth of the force s (x - centre_) is left.
  template <class Problem>
  bool minimise(Problem& problem, VectorX& x, double s, int& iterations) noexcept {
    constexpr int most = 14;
    for (;; ++iterations) {
      if (!(problem.evaluate(x, residual_) < infinity)) return false;
      residual_ -= s * (x - centre_);
      const double wanted = std::max(0.1 * s * (x - centre_).norm(), problem.rounding());
      if (iterations > 0 && residual_.norm() <= wanted) return true;
      if (iterations == most) return false;
      problem.assemble(x);
      if (!tangent_.factorise_shifted(s)) return false;
      tangent_.solve(residual_, step_);
      const double longest = step_.cwiseAbs().maxCoeff(), limit = 0.1 * problem.extent();
      if (!(longest < infinity)) return false;
      x += (longest > limit ? limit / longest : 1.0) * step_;
    }
  }

  detail::TangentSolver& tangent_;
  VectorX residual_, step_, centre_, mode_;
};

struct EquilibriumParameters {
  NewtonParameters newton{};
  int load_steps = 1;           ///< initial number; a step that fails is halved, one that converges fast is doubled
  double smallest_step = 1e-4;  ///< fraction of the loads; the solve stops when a step would be smaller
};

/// Options for making a body from a mesh.
struct EquilibriumOptions {
  AdmissionPolicy admission{};
  SetupLimits limits{};
};

struct EquilibriumReport {
  bool converged = false;
  int load_steps = 0, iterations = 0, refused_steps = 0;
  double fraction = 0.0;            ///< fraction of the loads for which equilibrium was found
  double relative_residual = 0.0;   ///< of the last step
  bool stable = true;               ///< the tangent stiffness is positive definite in the final state
  DeformationReport deformation{};  ///< element ids are those of the mesh as given
};

/// Describes the result in one sentence.
std::string describe(const EquilibriumReport& r);

/// A body under dead loads and prescribed displacements, at rest or so slow that inertia is negligible. Neither
/// copyable nor movable.
class Equilibrium {
 public:
  /// Admits the mesh like other tissues. One material everywhere or one per region: hyperelastic, linear or
  /// viscoelastic. Throws the errors of admit, make_deformable_body and conditions, and unconstrained; ids are those of
  /// the mesh as given. Vectors have 3 entries per node of the admitted mesh, see `node_map`.
  template <Element E, Material M>
  Equilibrium(const Mesh<E>& mesh, const Scene& scene, const M& material, const EquilibriumOptions& options = {})
      : Equilibrium(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}
  template <Element E, Material M>
  Equilibrium(const Mesh<E>& mesh, const Scene& scene, const RegionMaterials<M>& materials,
              const EquilibriumOptions& options = {})
      : Equilibrium(prepare(mesh, scene, materials, options), options.limits) {}
  /// From the body of an admitted mesh; its geometry is not checked. Throws the errors of make_deformable_body, and
  /// unconstrained.
  template <Element E, LargeStrainMaterial M>
  Equilibrium(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {})
      : Equilibrium(make_constrained_body(std::move(body), scene, limits), limits) {}
  /// From a constrained body of an admitted mesh, with or without mass, at small or large strain.
  explicit Equilibrium(DeformableBody body, const SetupLimits& limits = {});
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Raises the loads from zero to their full values. The result is in `displacement()`. A viscoelastic body is relaxed
  /// completely (time to infinity). Throws bad_argument for invalid parameters.
  EquilibriumReport solve(const EquilibriumParameters& parameters = {});

  /// Advances time by dt >= 0 [s]; loads and prescribed values reach their set values at the end of the step:
  /// relaxation and creep without inertia. dt = 0 is a sudden change. When no equilibrium is found, the state is
  /// unchanged. Throws bad_argument for a negative or NaN dt and for invalid parameters.
  EquilibriumReport step(double dt, const EquilibriumParameters& parameters = {});

  /// Sets the dead loads from the next `solve` or `step` on [N]. Throws bad_argument for a wrong size.
  void set_load(const VectorX& load);
  /// Sets the values of the prescribed components at the end of the next `solve` or `step` [m]. Throws as set_load.
  void set_prescribed(const VectorX& values);

  /// New id of every node of the mesh as given, -1 for nodes dropped at admission. Empty when the constructor received
  /// a body.
  const std::vector<NodeId>& node_map() const noexcept { return node_map_; }
  const EssentialConditions& conditions() const noexcept { return body_.conditions; }
  const VectorX& displacement() const noexcept { return displacement_; }
  double energy() const noexcept { return body_.elastic->energy(displacement_); }
  VectorX internal_force() const;
  /// Reaction forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const;
  /// Moves the body out; no other function may be called afterwards. Positions of a body made from a mesh are relative
  /// to the centre of its bounding box.
  DeformableBody take() &&;

  // NewtonProblem, at the present loads
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept;
  bool prepare(const VectorX& x) noexcept;
  void direction(const VectorX& residual, VectorX& d) noexcept;
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept { return rounding_; }
  // and of ProximalDescent
  void assemble(const VectorX& x) noexcept;
  double extent() const noexcept { return size_; }

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
    Prepared prepared{{}, detail::original_ids(admitted), std::move(admitted.node_map)};
    const ScopedIdTranslation translation(prepared.ids);
    const Vector3 origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
    for (Vector3& x : admitted.mesh.positions) x -= origin;
    const Scene mapped = scene.mapped(prepared.node_map, origin);
    detail::require_constrained(
        admitted.mesh, resolve_essential(admitted.mesh, extract_boundary<E>(admitted.mesh), mapped).constrained,
        origin);
    prepared.body =
        make_constrained_body(detail::make_any_body(std::move(admitted.mesh), materials), mapped, options.limits);
    return prepared;
  }
  Equilibrium(Prepared prepared, const SetupLimits& limits);
  Equilibrium(Prepared& prepared, const SetupLimits& limits, const ScopedIdTranslation&);

  static void require_usable(const EquilibriumParameters& p);

  void end() noexcept;

  /// Goes from the initial loads and prescribed values to the set ones, in adaptive steps.
  EquilibriumReport follow_loads(const EquilibriumParameters& parameters);

  /// Interpolates loads and prescribed values at a fraction between the initial and the set values.
  void go(double fraction) noexcept;
  /// Full displacement from the free dofs and the current prescribed values.
  void scatter(const VectorX& x) noexcept { body_.conditions.scatter(x, prescribed_, displacement_); }

  /// Goes from the equilibrium at the current loads to that at another fraction: a tangent step, then Newton's method,
  /// then `settle` where tangents are not positive definite.
  NewtonReport advance(detail::NewtonMethod& newton, double to) noexcept;

  /// Minimises the potential at the current loads: from an unstable equilibrium (a column under axial compression), or
  /// where Newton's method met tangents that are not positive definite.
  NewtonReport minimise(detail::NewtonMethod& newton) noexcept;
  /// True if the tangent stiffness at x_ is positive definite.
  bool is_stable() noexcept;

  OriginalIds ids_;
  std::vector<NodeId> node_map_;
  DeformableBody body_;
  detail::TangentSolver tangent_;
  VectorX displacement_, force_, full_, prescribed_, load_, from_prescribed_, from_load_;
  ProximalDescent descent_;
  VectorX x_, start_, residual_, direction_;
  int indefinite_ = 0;      // tangents in succession that were not positive definite
  int descent_budget_ = 0;  // factorisations
  double tolerance_ = 0.0;
  bool stepped_ = false;  // displacement_ is the end of a step
  double scale_ = 0.0, size_ = 0.0, rounding_ = 0.0;
};

namespace detail {

/// Displacement of the equilibrium under all loads [m]. Throws not_converged.
inline VectorX settled(Equilibrium& statics) {
  const EquilibriumReport report = statics.solve();
  if (!report.converged) {
    SetupProblem p;
    p.kind = SetupErrorKind::not_converged;
    p.what = "no equilibrium was found beyond " + number(100.0 * report.fraction) + " % of the loads";
    p.hint = "Set settle = false, or add supports";
    if (const Index worst = report.deformation.worst_element; worst >= 0) {
      p.what += "; the most deformed element has a volume ratio of " + number(report.deformation.smallest_volume_ratio);
      p.set_ids({&worst, 1}, SetupIds::elements);
    }
    raise(std::move(p));
  }
  return statics.displacement();
}

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/equilibrium.ipp>
#endif
