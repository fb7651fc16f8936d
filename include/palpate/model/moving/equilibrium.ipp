// Definitions of equilibrium.hpp.
#pragma once

#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/integrator/detail/requirements.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ProximalDescent::ProximalDescent(detail::TangentSolver& tangent, Index size)
    : tangent_(tangent), residual_(size), step_(size), centre_(size), mode_(size) {
  forget();
}

PALPATE_INLINE void ProximalDescent::forget() noexcept {
  for (Index i = 0; i < mode_.size(); ++i) mode_[i] = std::sin(1.0 + static_cast<double>(i));
}

PALPATE_INLINE bool ProximalDescent::find_shift(double& shift, int& count) noexcept {
  constexpr int most_attempts = 12;
  ++count;
  if (!tangent_.factorise()) return false;
  shift = tangent_.shift() > 0.0 ? tangent_.shift() : 1e-3 * tangent_.largest_diagonal();
  double too_small = 0.0;
  for (int k = 0; k < most_attempts; ++k) {
    // a large shift hides the soft modes: it decreases step by step, and the mode becomes accurate with it
    const double curvature = soften();
    double next = curvature < 0.0 ? -2.0 * curvature : shift / 16.0;
    if (next <= too_small) next = std::sqrt(too_small * shift);
    if (!(next < 0.5 * shift)) break;
    ++count;
    if (tangent_.factorise_shifted(next)) {
      shift = next;
    } else {
      too_small = next;
      if (!tangent_.factorise_shifted(shift)) return false;
      ++count;
      if (shift <= 4.0 * too_small) break;
    }
  }
  soften();
  mode_.normalize();
  return true;
}

PALPATE_INLINE double ProximalDescent::soften() noexcept {
  double curvature = 0.0;
  for (int k = 0; k < 6; ++k) {
    mode_.normalize();
    tangent_.solve(mode_, step_);
    curvature = 1.0 / mode_.dot(step_) - tangent_.shift();
    mode_.swap(step_);
  }
  return curvature;
}

PALPATE_INLINE std::string describe(const EquilibriumReport& r) {
  if (!r.converged)
    return "no equilibrium was found beyond " + number(100.0 * r.fraction) +
           " % of the loads; the most deformed element is " + std::to_string(r.deformation.worst_element) +
           " with a volume ratio of " + number(r.deformation.smallest_volume_ratio);
  std::string text = "equilibrium after " + std::to_string(r.load_steps) + " load steps and " +
                     std::to_string(r.iterations) + " iterations, residual " + number(r.relative_residual);
  if (!r.stable) text += ", not stable";
  if (r.deformation.inverted > 0)
    text += ", " + std::to_string(r.deformation.inverted) + " inverted elements, the worst is " +
            std::to_string(r.deformation.worst_element);
  if (r.deformation.beyond_range > 0)
    text += ", " + std::to_string(r.deformation.beyond_range) +
            " elements beyond the range of their material, which yields there: see docs/materials.md";
  return text;
}

PALPATE_INLINE Equilibrium::Equilibrium(Prepared prepared, const SetupLimits& limits)
    : Equilibrium(prepared, limits, ScopedIdTranslation(prepared.ids)) {}
PALPATE_INLINE Equilibrium::Equilibrium(Prepared& prepared, const SetupLimits& limits, const ScopedIdTranslation&)
    : Equilibrium(std::move(prepared.body), limits) {
  ids_ = std::move(prepared.ids);
  node_map_ = std::move(prepared.node_map);
}

PALPATE_INLINE Equilibrium::Equilibrium(DeformableBody body, const SetupLimits& limits)
    : body_(std::move(body)),
      tangent_(body_.pattern, body_.conditions, body_.positions, limits),
      displacement_(VectorX::Zero(body_.elastic->size())),
      force_(displacement_),
      full_(displacement_),
      prescribed_(displacement_),
      load_(displacement_),
      from_prescribed_(displacement_),
      from_load_(displacement_),
      descent_(tangent_, size()),
      x_(VectorX::Zero(size())),
      start_(x_),
      residual_(x_),
      direction_(x_),
      size_(palpate::detail::extent(body_.positions)) {
  body_.elastic->tangent(displacement_, tangent_.matrix());
  if (!body_.elastic->is_linear()) rounding_ = tangent_.rounding(size_);
}

PALPATE_INLINE EquilibriumReport Equilibrium::solve(const EquilibriumParameters& parameters) {
  require_usable(parameters);
  stepped_ = false;
  tangent_.forget();
  descent_.forget();
  body_.elastic->begin_step(infinity);
  from_prescribed_.setZero();
  from_load_.setZero();
  x_.setZero();
  return follow_loads(parameters);
}

PALPATE_INLINE EquilibriumReport Equilibrium::step(double dt, const EquilibriumParameters& parameters) {
  require_usable(parameters);
  if (!(dt >= 0.0)) raise(SetupErrorKind::bad_argument, "a step of " + number(dt), "Give a time in seconds");
  end();
  body_.elastic->begin_step(dt);
  from_prescribed_ = prescribed_;
  from_load_ = load_;
  const VectorX before = x_;
  const EquilibriumReport report = follow_loads(parameters);
  if (!report.converged) {
    x_ = before;
    go(0.0);
    scatter(x_);
    body_.elastic->begin_step(0.0);
  }
  return report;
}

PALPATE_INLINE void Equilibrium::set_load(const VectorX& load) {
  detail::require_entries(load, displacement_.size());
  body_.load = load;
}

PALPATE_INLINE void Equilibrium::set_prescribed(const VectorX& values) {
  detail::require_entries(values, displacement_.size());
  body_.conditions.prescribed = values;
}

PALPATE_INLINE VectorX Equilibrium::internal_force() const {
  VectorX f(displacement_.size());
  body_.elastic->force(displacement_, f);
  return f;
}

PALPATE_INLINE VectorX Equilibrium::reactions() const {
  VectorX r = internal_force() - load_;
  for (const Index dof : body_.conditions.free_dofs) r[dof] = 0.0;
  return r;
}

PALPATE_INLINE DeformableBody Equilibrium::take() && {
  end();
  return std::move(body_);
}

PALPATE_INLINE double Equilibrium::evaluate(const VectorX& x, VectorX& residual) noexcept {
  scatter(x);
  const DeformationReport deformation = body_.elastic->force(displacement_, force_);
  if (!deformation.admissible) return infinity;
  scale_ = std::max(force_.norm(), load_.norm());
  full_ = load_ - force_;
  body_.conditions.gather(full_, residual);
  return body_.elastic->energy(displacement_) - load_.dot(displacement_);
}

PALPATE_INLINE void Equilibrium::assemble(const VectorX& x) noexcept {
  scatter(x);
  body_.elastic->tangent(displacement_, tangent_.matrix());
}

PALPATE_INLINE bool Equilibrium::prepare(const VectorX& x) noexcept {
  constexpr int most_indefinite = 4;  // then `settle` takes over
  assemble(x);
  if (!tangent_.factorise()) return false;
  indefinite_ = tangent_.shift() > 0.0 ? indefinite_ + 1 : 0;
  return indefinite_ <= most_indefinite;
}

PALPATE_INLINE void Equilibrium::direction(const VectorX& residual, VectorX& d) noexcept {
  tangent_.solve(residual, d);
}

PALPATE_INLINE void Equilibrium::require_usable(const EquilibriumParameters& p) {
  p.newton.require_usable();
  if (p.load_steps < 1)
    raise(SetupErrorKind::bad_argument, std::to_string(p.load_steps) + " load steps", "Give at least one");
  if (!(p.smallest_step > 0.0 && p.smallest_step <= 1.0))
    raise(SetupErrorKind::bad_argument, "a smallest load step of " + number(p.smallest_step),
          "Give a fraction of the loads above 0 and at most 1");
}

PALPATE_INLINE void Equilibrium::end() noexcept {
  if (stepped_) body_.elastic->end_step(displacement_);
  stepped_ = false;
}

PALPATE_INLINE EquilibriumReport Equilibrium::follow_loads(const EquilibriumParameters& parameters) {
  EquilibriumReport report;
  detail::NewtonMethod newton(size(), parameters.newton);
  descent_budget_ = 300;
  tolerance_ = parameters.newton.tolerance;
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
  report.stable = is_stable();
  if (report.converged && !report.stable) {
    start_ = x_;
    const NewtonReport found = minimise(newton);
    report.iterations += found.iterations;
    if (found.converged)
      report.relative_residual = found.relative_residual;
    else
      x_ = start_;
    report.stable = is_stable();
  }
  report.deformation = body_.elastic->force(displacement_, force_);
  Index& worst = report.deformation.worst_element;
  if (worst >= 0 && !ids_.elements.empty()) worst = ids_.elements[static_cast<std::size_t>(worst)];
  stepped_ = report.converged;
  return report;
}

PALPATE_INLINE void Equilibrium::go(double fraction) noexcept {
  prescribed_ = from_prescribed_ + fraction * (body_.conditions.prescribed - from_prescribed_);
  load_ = from_load_ + fraction * (body_.load - from_load_);
}

PALPATE_INLINE NewtonReport Equilibrium::advance(detail::NewtonMethod& newton, double to) noexcept {
  indefinite_ = 0;
  if (!prepare(x_)) return {};
  body_.elastic->force(displacement_, force_);
  displacement_ = prescribed_;
  go(to);
  displacement_ = prescribed_ - displacement_;
  tangent_.matrix().apply(displacement_, full_);
  full_ = load_ - force_ - full_;
  body_.conditions.gather(full_, residual_);
  direction(residual_, direction_);
  x_ += direction_;
  indefinite_ = 0;
  const NewtonReport found = newton.solve(*this, x_);
  if (indefinite_ == 0) return found;
  NewtonReport settled = minimise(newton);
  settled.iterations += found.iterations;
  return settled;
}

PALPATE_INLINE NewtonReport Equilibrium::minimise(detail::NewtonMethod& newton) noexcept {
  NewtonReport report;
  for (int k = 0; k < 3 && descent_budget_ > 0; ++k) {
    int count = 0;
    const bool found = descent_.run(*this, x_, tolerance_, descent_budget_, count);
    descent_budget_ -= count;
    const int before = report.iterations + count;
    if (!found) {
      report = {};
      report.iterations = before;
      return report;
    }
    report = newton.solve(*this, x_);
    report.iterations += before;
    if (report.converged && is_stable()) return report;
  }
  return report;
}

PALPATE_INLINE bool Equilibrium::is_stable() noexcept {
  assemble(x_);
  return tangent_.factorise_shifted(0.0);
}

}}  // namespace palpate
