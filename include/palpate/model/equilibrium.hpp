// Static equilibrium at large deformation, by Newton's method along a path of loads.
#pragma once

#include <palpate/integrator/newton.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/tangent_solver.hpp>

#include <Eigen/Geometry>

namespace palpate::inline PALPATE_ABI {

struct EquilibriumParameters {
  NewtonParameters newton{};
  int load_steps = 1;           ///< to start with; a step that fails is halved, one that is easy doubled
  double smallest_step = 1e-4;  ///< of the loads; a smaller one gives up
};

struct EquilibriumReport {
  bool converged = false;
  int load_steps = 0, iterations = 0, refused_steps = 0;
  double fraction = 0.0;           ///< of the loads that are in equilibrium
  double relative_residual = 0.0;  ///< of the last step
  bool stable = true;              ///< the tangent stiffness is positive definite there
  DeformationReport deformation{};
};

/// What was reached, in a sentence.
inline std::string describe(const EquilibriumReport& r) {
  if (!r.converged)
    return "no equilibrium was found beyond " + number(100.0 * r.fraction) +
           " % of the loads; the most deformed element is " + std::to_string(r.deformation.worst_element) +
           " with a volume ratio of " + number(r.deformation.smallest_volume_ratio);
  std::string text = "equilibrium after " + std::to_string(r.load_steps) + " load steps and " +
                     std::to_string(r.iterations) + " iterations, residual " + number(r.relative_residual);
  if (!r.stable) text += ", not stable";
  if (r.deformation.inverted > 0)
    text += ", " + std::to_string(r.deformation.inverted) + " elements inside out, first of all " +
            std::to_string(r.deformation.worst_element);
  return text;
}

/// A body under dead loads and prescribed displacements. Neither copied nor moved.
class Equilibrium {
 public:
  /// Throws what make_deformable_body throws, and unconstrained.
  template <Element E, HyperelasticMaterial M>
  Equilibrium(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {})
      : body_(held(std::move(body), scene, limits)),
        tangent_(body_.pattern, body_.conditions, body_.positions, limits),
        displacement_(VectorX::Zero(body_.elastic->size())),
        force_(displacement_),
        full_(displacement_),
        buckling_(VectorX::NullaryExpr(size(), [](Index i) { return std::sin(1.0 + static_cast<double>(i)); })),
        trial_(size()) {
    Eigen::AlignedBox3d box;
    for (const Vector3& x : body_.positions) box.extend(x);
    size_ = box.diagonal().norm();
    body_.elastic->tangent(displacement_, tangent_.matrix());
    rounding_ = std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(size())) *
                tangent_.largest_diagonal() * size_;
  }
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Raises the loads from none to all. What is reached at the end is in `displacement()`.
  EquilibriumReport solve(const EquilibriumParameters& parameters = {}) {
    EquilibriumReport report;
    Newton newton(body_.conditions.free_count(), parameters.newton);
    displacement_.setZero();
    fraction_ = 0.0;
    VectorX x = VectorX::Zero(body_.conditions.free_count()), start = x;
    double step = 1.0 / std::max(1, parameters.load_steps);
    while (fraction_ < 1.0) {
      const double from = fraction_, to = std::min(1.0, from + step);
      start = x;
      const NewtonReport found = advance(newton, to, x);
      report.iterations += found.iterations;
      if (found.converged) {
        ++report.load_steps;
        report.relative_residual = found.relative_residual;
        if (found.iterations <= 6) step *= 2.0;
        continue;
      }
      ++report.refused_steps;
      report.relative_residual = found.relative_residual;
      x = start;
      fraction_ = from;
      step *= 0.5;
      if (step < parameters.smallest_step) break;
    }
    report.fraction = fraction_;
    report.converged = fraction_ == 1.0;
    place(x);
    report.deformation = body_.elastic->force(displacement_, force_);
    report.stable = prepare(x) && tangent_.shift() == 0.0;
    return report;
  }

  const ElasticForces& elastic() const noexcept { return *body_.elastic; }
  const EssentialConditions& conditions() const noexcept { return body_.conditions; }
  const VectorX& displacement() const noexcept { return displacement_; }
  double energy() const noexcept { return body_.elastic->energy(displacement_); }
  VectorX internal_force() const {
    VectorX f(displacement_.size());
    body_.elastic->force(displacement_, f);
    return f;
  }
  /// Forces of the supports, zero on free dofs, 3 per node [N].
  VectorX reactions() const {
    VectorX r = internal_force() - fraction_ * body_.load;
    for (const Index dof : body_.conditions.free_dofs) r[dof] = 0.0;
    return r;
  }

  // NewtonProblem, at the present fraction of the loads
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    place(x);
    const DeformationReport deformation = body_.elastic->force(displacement_, force_);
    if (!deformation.admissible) return infinity;
    scale_ = std::max(force_.norm(), fraction_ * body_.load.norm());
    full_ = fraction_ * body_.load - force_;
    body_.conditions.gather(full_, residual);
    return body_.elastic->energy(displacement_) - fraction_ * body_.load.dot(displacement_);
  }
  bool prepare(const VectorX& x) noexcept {
    place(x);
    body_.elastic->tangent(displacement_, tangent_.matrix());
    return tangent_.factorise();
  }
  void direction(const VectorX& residual, VectorX& d) noexcept {
    tangent_.solve(residual, d);
    if (tangent_.shift() > 0.0 && residual.norm() <= 1e-3 * scale_) add_way_down(residual, d);
  }
  double scale() const noexcept { return scale_; }
  double rounding() const noexcept { return rounding_; }

 private:
  template <Element E, HyperelasticMaterial M>
  static DeformableBody held(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits) {
    const Mesh<E>& mesh = body.rest.mesh;
    require_constrained(mesh, resolve_essential(mesh, extract_boundary<E>(mesh), scene).constrained);
    return make_deformable_body(std::move(body), scene, limits);
  }

  /// Full displacement from the free dofs, with prescribed ones at the present fraction.
  void place(const VectorX& x) noexcept {
    displacement_ = fraction_ * body_.conditions.prescribed;
    for (Index k = 0; k < body_.conditions.free_count(); ++k)
      displacement_[body_.conditions.free_dofs[static_cast<std::size_t>(k)]] = x[k];
  }

  /// From equilibrium at the present fraction to equilibrium at another: a step along the tangent, then Newton's
  /// method.
  NewtonReport advance(Newton& newton, double to, VectorX& x) noexcept {
    if (!prepare(x)) return {};
    body_.elastic->force(displacement_, force_);
    tangent_.matrix().apply((to - fraction_) * body_.conditions.prescribed, full_);
    full_ = to * body_.load - force_ - full_;
    VectorX residual(size()), d(size());
    body_.conditions.gather(full_, residual);
    direction(residual, d);
    fraction_ = to;
    x += d;
    return newton.solve(*this, x);
  }

  /// Where the tangent is not positive definite the state may be an unstable equilibrium, which the residual alone does
  /// not leave (a column pressed straight): adds the direction of most negative curvature, by inverse iteration.
  void add_way_down(const VectorX& residual, VectorX& d) noexcept {
    double softest = infinity;
    for (int k = 0; k < 6; ++k) {
      buckling_.normalize();
      tangent_.solve(buckling_, trial_);
      softest = 1.0 / buckling_.dot(trial_) - tangent_.shift();
      buckling_.swap(trial_);
    }
    if (!(softest < 0.0)) return;
    const double length = 0.02 * size_ / buckling_.cwiseAbs().maxCoeff();
    d += std::copysign(length, residual.dot(buckling_)) * buckling_;
  }

  DeformableBody body_;
  TangentSolver tangent_;
  VectorX displacement_, force_, full_, buckling_, trial_;
  double fraction_ = 0.0, scale_ = 0.0, size_ = 0.0, rounding_ = 0.0;
};

}  // namespace palpate::inline PALPATE_ABI
