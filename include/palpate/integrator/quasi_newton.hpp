// Minimisation without second derivatives: L-BFGS around an approximate factor.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

struct QuasiNewtonLimits {
  int maximum_iterations = 100;
  double tolerance = 1e-6;  ///< of the residual relative to the problem's scale
  int maximum_evaluations = 400;
  double reduction = 1.0;  ///< the residual must also fall to this share of its start ...
  double enough = 0.0;     ///< ... or to this share of the tolerance
};

struct QuasiNewtonReport {
  bool converged = false;
  int iterations = 0;   ///< steps tried
  int evaluations = 0;  ///< of energy and force
  double relative_residual = infinity;
};

namespace detail {

/// A potential with an approximate inverse of its second derivative.
/// - `evaluate(x, residual)`, `scale()`, `rounding()` as in NewtonProblem.
/// - `precondition(r, d)`: d = H r with a positive definite H, near the inverse of the second derivative.
/// - `potential_rounding()` is the error of the last potential that is due to rounding alone.
/// - `energy_scale()` is the size of the terms of the last potential, `energy_rounding()` the energy r.Hr of a residual
///   that is due to rounding alone.
/// - `is_uneven()`: the norm of the residual, dominated by stiff parts, may hide that soft ones are out of equilibrium.
template <class P>
concept QuasiNewtonProblem = requires(P& p, const VectorX& x, VectorX& y) {
  { p.evaluate(x, y) }
  noexcept->std::same_as<double>;
  { p.precondition(x, y) }
  noexcept;
  { p.scale() }
  noexcept->std::convertible_to<double>;
  { p.rounding() }
  noexcept->std::convertible_to<double>;
  { p.potential_rounding() }
  noexcept->std::convertible_to<double>;
  { p.energy_scale() }
  noexcept->std::convertible_to<double>;
  { p.energy_rounding() }
  noexcept->std::convertible_to<double>;
  { p.is_uneven() }
  noexcept->std::convertible_to<bool>;
};

}  // namespace detail

/// Limited-memory BFGS with H as the initial inverse (Nocedal and Wright, Numerical Optimization, 7.2; with a factor as
/// H: Liu, Bouaziz and Kavan 2017), and a line search with Armijo's rule; where differences of the potential are lost
/// to rounding, with the approximate rule of Hager and Zhang (2005). The potential does not increase by more than its
/// rounding error. Keeps its pairs from one problem to the next. Owns its workspaces: nothing allocates after the
/// constructor.
class QuasiNewtonMethod {
 public:
  QuasiNewtonMethod() = default;
  /// Allocates 2 `memory` + 7 vectors. Throws bad_argument unless `memory` is 1 to 100.
  explicit QuasiNewtonMethod(Index size, int memory = 6);

  /// Forgets all pairs. For a potential of another second derivative.
  void forget() noexcept { count_ = 0; }

  /// Evaluates the potential at x, where the next iteration starts. Returns it.
  template <detail::QuasiNewtonProblem P>
  double start(P& problem, const VectorX& x) noexcept {
    potential_ = problem.evaluate(x, residual_);
    return potential_;
  }
  /// The same when the caller knows the potential at x and has set residual().
  void start_from(double potential) noexcept { potential_ = potential; }
  /// One iteration from x, at which the problem must have been evaluated last; on return this holds for the new x.
  /// Returns false, with x unchanged, when no step was found.
  template <detail::QuasiNewtonProblem P>
  bool iterate(P& problem, VectorX& x, QuasiNewtonReport& report) noexcept;
  /// Iterates until the residual is small or a limit is reached. `start` comes first.
  template <detail::QuasiNewtonProblem P>
  QuasiNewtonReport solve(P& problem, VectorX& x, const QuasiNewtonLimits& limits) noexcept;

  /// d = inverse of the second derivative times r, as known from H and the pairs. One solve.
  template <detail::QuasiNewtonProblem P>
  void respond(P& problem, const VectorX& r, VectorX& d) noexcept {
    find_direction(problem, r, d);
  }

  /// Improves d, an approximate solution of A d = f with the second derivative A at x, where a problem was solved last:
  /// takes the best combination of d and the preconditioned residual (Rayleigh and Ritz). Call it after every step with
  /// the last d, which then follows A. Products with A are differences of the problem's residual over a small part of
  /// d, and are also stored as pairs. At most two evaluations and one solve, no allocation. Returns false, with d = 0,
  /// where A is not positive on these vectors.
  template <detail::QuasiNewtonProblem P>
  bool improve(P& problem, const VectorX& x, const VectorX& f, VectorX& d) noexcept;

  double potential() const noexcept { return potential_; }
  VectorX& residual() noexcept { return residual_; }

 private:
  template <class P>
  void find_direction(P& problem, const VectorX& r, VectorX& d) noexcept;
  /// The direction of the next step from the residual. Returns their product: energy of the residual, as far as known.
  template <class P>
  double find_direction(P& problem) noexcept;
  template <class P>
  bool search(P& problem, VectorX& x, double slope, QuasiNewtonReport& report) noexcept;
  /// y = A d at x.
  template <class P>
  bool multiply(P& problem, const VectorX& x, const VectorX& d, VectorX& y) noexcept;
  /// Stores the change of x and of the residual, unless the curvature is not positive, or their product below `least`.
  void remember(const VectorX& from, const VectorX& to, const VectorX& residual_there, double least) noexcept;
  Index newest(int back) const noexcept { return (next_ + memory_ - 1 - back) % memory_; }

  Index memory_ = 0, count_ = 0, next_ = 0;
  Eigen::MatrixXd steps_, changes_;  // one pair per column
  VectorX curvature_, weight_;       // 1 / (s . y), and a workspace
  VectorX residual_, direction_, trial_, trial_residual_, work_;
  VectorX product_, other_product_;  // of A and vectors
  double potential_ = infinity;
};

template <detail::QuasiNewtonProblem P>
QuasiNewtonReport QuasiNewtonMethod::solve(P& problem, VectorX& x, const QuasiNewtonLimits& limits) noexcept {
  QuasiNewtonReport report;
  if (!(potential_ < infinity)) return report;
  double start = infinity, energy_start = infinity;
  // Small enough, as force or as energy? `start` is the first of them.
  const auto is_small = [&](double relative, double& first) noexcept {
    if (first == infinity) first = relative;
    return relative <= std::min(limits.tolerance, std::max(limits.reduction * first, limits.enough * limits.tolerance));
  };
  for (;;) {
    const double norm = residual_.norm();
    const bool lost = norm <= problem.rounding();
    report.relative_residual = lost ? 0.0 : norm / problem.scale();
    report.converged = is_small(report.relative_residual, start);
    const bool by_energy = lost || problem.is_uneven();
    const bool ends =
        report.iterations >= limits.maximum_iterations || report.evaluations >= limits.maximum_evaluations;
    if ((report.converged || ends) && !by_energy) return report;
    const double work = find_direction(problem);
    if (!(work > problem.energy_rounding())) {
      report.converged = work >= 0.0;
      if (report.converged) report.relative_residual = 0.0;
      return report;
    }
    const double relative = std::sqrt(work / problem.energy_scale());
    const bool is_small_energy = is_small(relative, energy_start);
    if (by_energy) {
      report.converged = report.converged && is_small_energy;
      report.relative_residual = std::max(report.relative_residual, relative);
    }
    if (report.converged || ends) return report;
    ++report.iterations;
    if (!(work < infinity) || !search(problem, x, work, report)) return report;
  }
}

template <detail::QuasiNewtonProblem P>
bool QuasiNewtonMethod::iterate(P& problem, VectorX& x, QuasiNewtonReport& report) noexcept {
  const double work = find_direction(problem);
  ++report.iterations;
  return work > 0.0 && work < infinity && search(problem, x, work, report);
}

template <class P>
double QuasiNewtonMethod::find_direction(P& problem) noexcept {
  find_direction(problem, residual_, direction_);
  double work = residual_.dot(direction_);
  if (!(work > 0.0) && count_ > 0) {  // stale pairs
    forget();
    find_direction(problem, residual_, direction_);
    work = residual_.dot(direction_);
  }
  return work;
}

template <class P>
void QuasiNewtonMethod::find_direction(P& problem, const VectorX& r, VectorX& d) noexcept {
  work_ = r;
  for (int k = 0; k < count_; ++k) {
    const Index p = newest(k);
    weight_[p] = curvature_[p] * steps_.col(p).dot(work_);
    work_ -= weight_[p] * changes_.col(p);
  }
  problem.precondition(work_, d);
  for (int k = static_cast<int>(count_) - 1; k >= 0; --k) {
    const Index p = newest(k);
    d += (weight_[p] - curvature_[p] * changes_.col(p).dot(d)) * steps_.col(p);
  }
}

template <class P>
bool QuasiNewtonMethod::search(P& problem, VectorX& x, double slope, QuasiNewtonReport& report) noexcept {
  double length = 1.0;
  for (int k = 0; k < 8; ++k) {
    trial_ = x + length * direction_;
    const double next = problem.evaluate(trial_, trial_residual_);
    ++report.evaluations;
    if (!(next < infinity)) {
      length *= 0.25;
      continue;
    }
    const bool lower = next <= potential_ - 1e-4 * length * slope;
    const bool level =
        next <= potential_ + problem.potential_rounding() && trial_residual_.dot(direction_) >= -0.8 * slope;
    if (lower || level) {
      remember(x, trial_, trial_residual_, problem.energy_rounding());
      x.swap(trial_);
      residual_.swap(trial_residual_);
      potential_ = next;
      return true;
    }
    const double excess = next - potential_ + length * slope;  // of the parabola through both values
    length *= std::clamp(0.5 * length * slope / excess, 0.1, 0.5);
  }
  problem.evaluate(x, residual_);
  return false;
}

template <class P>
bool QuasiNewtonMethod::multiply(P& problem, const VectorX& x, const VectorX& d, VectorX& y) noexcept {
  constexpr double part = 0.01;
  trial_ = x + part * d;
  if (!(problem.evaluate(trial_, trial_residual_) < infinity)) return false;
  remember(x, trial_, trial_residual_, 0.0);
  y = (residual_ - trial_residual_) / part;
  return true;
}

template <detail::QuasiNewtonProblem P>
bool QuasiNewtonMethod::improve(P& problem, const VectorX& x, const VectorX& f, VectorX& d) noexcept {
  constexpr double exact = 1e-3;       // smaller residuals are lost to the rounding of the differences
  constexpr double least_part = 1e-9;  // of the energy of a direction, beside d
  VectorX &of_d = product_, &other = direction_, &of_other = other_product_;
  const auto fail = [&]() noexcept {
    d.setZero();
    return false;
  };
  of_d.setZero();
  double energy = 0.0;
  if (!d.isZero(0.0)) {
    if (!multiply(problem, x, d, of_d) || !((energy = d.dot(of_d)) > 0.0)) return fail();
    const double best = d.dot(f) / energy;
    d *= best;
    of_d *= best;
    energy *= best * best;
  }
  of_other = f - of_d;
  if (of_other.norm() <= exact * f.norm()) return true;
  find_direction(problem, of_other, other);
  if (!multiply(problem, x, other, of_other)) return fail();
  const double all = other.dot(of_other);
  if (!(all > 0.0)) return fail();
  if (energy > 0.0) {  // conjugate to d, so that the best step along it keeps d
    const double along = other.dot(of_d) / energy;
    other -= along * d;
    of_other -= along * of_d;
  }
  const double beside = other.dot(of_other);
  if (beside > least_part * all) d += other.dot(f) / beside * other;
  return true;
}

inline QuasiNewtonMethod::QuasiNewtonMethod(Index size, int memory)
    : memory_(memory),
      residual_(size),
      direction_(size),
      trial_(size),
      trial_residual_(size),
      work_(size),
      product_(size),
      other_product_(size) {
  if (memory < 1 || memory > 100)
    raise(SetupErrorKind::bad_argument, "a memory of " + std::to_string(memory) + " pairs", "Give 1 to 100");
  steps_.setZero(size, memory);
  changes_.setZero(size, memory);
  curvature_.setZero(memory);
  weight_.setZero(memory);
}

inline void QuasiNewtonMethod::remember(const VectorX& from, const VectorX& to, const VectorX& residual_there,
                                        double least) noexcept {
  auto step = steps_.col(next_), change = changes_.col(next_);
  step = to - from;
  change = residual_ - residual_there;
  const double product = step.dot(change);
  if (!(product > least) || !(product > 1e-8 * step.norm() * change.norm())) return;
  curvature_[next_] = 1.0 / product;
  next_ = (next_ + 1) % memory_;
  count_ = std::min(count_ + 1, memory_);
}

}}  // namespace palpate
