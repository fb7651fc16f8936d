// Static equilibrium at large deformation, by Newton's method along a path of loads.
#pragma once

#include <palpate/integrator/newton.hpp>
#include <palpate/integrator/requirements.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/tangent_solver.hpp>

namespace palpate { inline namespace PALPATE_ABI {

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

/// A body under dead loads and prescribed displacements, at rest or so slow that inertia does not count. Neither copied
/// nor moved.
class Equilibrium {
 public:
  /// Throws what make_deformable_body throws, and unconstrained.
  template <Element E, LargeStrainMaterial M>
  Equilibrium(HyperelasticBody<E, M> body, const Scene& scene, const SetupLimits& limits = {})
      : Equilibrium(make_held_body(std::move(body), scene, limits), limits) {}
  /// A body that is held, with or without mass, at any strain.
  explicit Equilibrium(DeformableBody body, const SetupLimits& limits = {})
      : body_(std::move(body)),
        tangent_(body_.pattern, body_.conditions, body_.positions, limits),
        displacement_(VectorX::Zero(body_.elastic->size())),
        force_(displacement_),
        full_(displacement_),
        held_(displacement_),
        load_(displacement_),
        from_held_(displacement_),
        from_load_(displacement_),
        x_(VectorX::Zero(size())),
        start_(x_),
        residual_(x_),
        direction_(x_),
        buckling_(VectorX::NullaryExpr(size(), [](Index i) { return std::sin(1.0 + static_cast<double>(i)); })),
        trial_(x_),
        size_(extent(body_.positions)) {
    body_.elastic->tangent(displacement_, tangent_.matrix());
    if (!body_.elastic->is_linear()) rounding_ = tangent_.rounding(size_);
  }
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// Raises the loads from none to all. What is reached at the end is in `displacement()`. A body with memory is held
  /// there until nothing fades any more. Throws bad_argument for parameters that cannot be.
  EquilibriumReport solve(const EquilibriumParameters& parameters = {}) {
    require_usable(parameters);
    stepped_ = false;
    body_.elastic->begin_step(infinity);
    from_held_.setZero();
    from_load_.setZero();
    x_.setZero();
    return follow_loads(parameters);
  }

  /// Lets dt >= 0 seconds pass, at the end of which loads and prescribed values are as they are set: relaxation and
  /// creep without inertia. dt = 0 is a sudden change. Where no equilibrium is found nothing has changed. Throws
  /// bad_argument.
  EquilibriumReport step(double dt, const EquilibriumParameters& parameters = {}) {
    require_usable(parameters);
    if (!(dt >= 0.0)) raise(SetupErrorKind::bad_argument, "a step of " + number(dt), "Give a time in seconds");
    end();
    body_.elastic->begin_step(dt);
    from_held_ = held_;
    from_load_ = load_;
    const VectorX before = x_;
    const EquilibriumReport report = follow_loads(parameters);
    if (!report.converged) {
      x_ = before;
      go(0.0);
      place(x_);
      body_.elastic->begin_step(0.0);
    }
    return report;
  }

  /// Dead loads from the next `solve` or `step` on [N]. Throws bad_argument for another size.
  void set_load(const VectorX& load) {
    require_entries(load, displacement_.size());
    body_.load = load;
  }
  /// Values of the prescribed components at the end of the next `solve` or `step` [m]. Throws as set_load.
  void set_prescribed(const VectorX& values) {
    require_entries(values, displacement_.size());
    body_.conditions.prescribed = values;
  }

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
    VectorX r = internal_force() - load_;
    for (const Index dof : body_.conditions.free_dofs) r[dof] = 0.0;
    return r;
  }
  /// Gives the body away. Nothing else may be called after it.
  DeformableBody release() && {
    end();
    return std::move(body_);
  }

  // NewtonProblem, at the present loads
  Index size() const noexcept { return body_.conditions.free_count(); }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    place(x);
    const DeformationReport deformation = body_.elastic->force(displacement_, force_);
    if (!deformation.admissible) return infinity;
    scale_ = std::max(force_.norm(), load_.norm());
    full_ = load_ - force_;
    body_.conditions.gather(full_, residual);
    return body_.elastic->energy(displacement_) - load_.dot(displacement_);
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
  static void require_usable(const EquilibriumParameters& p) {
    p.newton.require_usable();
    if (p.load_steps < 1)
      raise(SetupErrorKind::bad_argument, std::to_string(p.load_steps) + " load steps", "Give at least one");
    if (!(p.smallest_step > 0.0 && p.smallest_step <= 1.0))
      raise(SetupErrorKind::bad_argument, "a smallest load step of " + number(p.smallest_step),
            "Give a part of the loads above 0 and at most 1");
  }

  void end() noexcept {
    if (stepped_) body_.elastic->end_step(displacement_);
    stepped_ = false;
  }

  /// From the loads and held values at the start to those that are set, in steps that adapt.
  EquilibriumReport follow_loads(const EquilibriumParameters& parameters) {
    EquilibriumReport report;
    Newton newton(size(), parameters.newton);
    go(0.0);
    double step = 1.0 / parameters.load_steps;
    while (report.fraction < 1.0) {
      const double to = std::min(1.0, report.fraction + step);
      start_ = x_;
      const NewtonReport found = advance(newton, to);
      report.iterations += found.iterations;
      report.relative_residual = found.relative_residual;
      if (found.converged) {
        ++report.load_steps;
        report.fraction = to;
        if (found.iterations <= 6) step *= 2.0;
        continue;
      }
      ++report.refused_steps;
      x_ = start_;
      go(report.fraction);
      step *= 0.5;
      if (step < parameters.smallest_step) break;
    }
    report.converged = report.fraction == 1.0;
    report.stable = prepare(x_) && tangent_.shift() == 0.0;
    report.deformation = body_.elastic->force(displacement_, force_);
    stepped_ = report.converged;
    return report;
  }

  /// Sets loads and held values to a fraction of the way.
  void go(double fraction) noexcept {
    held_ = from_held_ + fraction * (body_.conditions.prescribed - from_held_);
    load_ = from_load_ + fraction * (body_.load - from_load_);
  }
  /// Full displacement from the free dofs, with the present held values.
  void place(const VectorX& x) noexcept { body_.conditions.place(x, held_, displacement_); }

  /// From equilibrium at the present loads to equilibrium at another fraction: a step along the tangent, then Newton's
  /// method.
  NewtonReport advance(Newton& newton, double to) noexcept {
    if (!prepare(x_)) return {};
    body_.elastic->force(displacement_, force_);
    displacement_ = held_;
    go(to);
    displacement_ = held_ - displacement_;
    tangent_.matrix().apply(displacement_, full_);
    full_ = load_ - force_ - full_;
    body_.conditions.gather(full_, residual_);
    direction(residual_, direction_);
    x_ += direction_;
    return newton.solve(*this, x_);
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
  VectorX displacement_, force_, full_, held_, load_, from_held_, from_load_;
  VectorX x_, start_, residual_, direction_, buckling_, trial_;
  bool stepped_ = false;  // displacement_ is the end of a step
  double scale_ = 0.0, size_ = 0.0, rounding_ = 0.0;
};

}}  // namespace palpate
