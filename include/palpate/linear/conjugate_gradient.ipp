// Definitions of conjugate_gradient.hpp.
#pragma once

#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<IterativeSolver>);

PALPATE_INLINE ConjugateGradientSolver::ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters)
    : parameters_(parameters), r_(size), z_(size), p_(size), q_(size), best_(size) {
  if (parameters_.maximum_iterations <= 0)
    parameters_.maximum_iterations = static_cast<int>(std::clamp<Index>(40 * size, 100, 12'000));
}

PALPATE_INLINE SolveReport ConjugateGradientSolver::solve_into(const OperatorView& op, const VectorX& b,
                                                               VectorX& x) noexcept {
  SolveReport report{.converged = false};
  detail::fill(x, 0.0);
  r_ = b;
  const Norms load = precondition_residual(op);
  if (!(load.plain > 0.0) || !std::isfinite(load.plain)) {
    report.converged = load.plain == 0.0;
    return report;
  }
  best_ = x;
  operator_norm_ = 0.0;
  Norms reached = load;
  bool going = true, at_floor = false;
  while (going && !at_floor && !report.converged) {
    going = iterate(op, load, reached, x, report.iterations);
    op.apply(x, q_);
    detail::subtract(b, q_, r_);
    const Norms now = precondition_residual(op);
    at_floor = !(now.preconditioned < 0.5 * reached.preconditioned);
    if (!(now.preconditioned < reached.preconditioned)) break;
    reached = now;
    best_ = x;
    report.converged = now.within(parameters_.tolerance, load);
  }
  x = best_;
  report.relative_residual = reached.plain / load.plain;
  constexpr double attainable = 1e-12;
  const double scale = operator_norm_ * detail::norm(x) + load.plain;
  report.converged =
      report.converged || (going && reached.plain <= std::max(parameters_.tolerance, attainable) * scale);
  return report;
}

PALPATE_INLINE ConjugateGradientSolver::Norms ConjugateGradientSolver::precondition_residual(
    const OperatorView& op) noexcept {
  op.precondition(r_, z_);
  return {detail::norm(r_), std::sqrt(detail::dot(r_, z_))};
}

PALPATE_INLINE bool ConjugateGradientSolver::iterate(const OperatorView& op, const Norms& load, const Norms& start,
                                                     VectorX& x, int& iterations) noexcept {
  constexpr double most_per_round = 1e-8;
  Norms now = start;
  bool first = true;
  p_ = z_;
  while (!now.within(0.5 * parameters_.tolerance, load) && now.preconditioned > most_per_round * start.preconditioned) {
    if (iterations == parameters_.maximum_iterations) return false;
    op.apply(p_, q_);
    const double curvature = detail::dot(p_, q_);
    if (!(curvature > 0.0) || !std::isfinite(curvature)) return false;
    if (first) {  // K p is rich in the stiffest motions
      op.apply(q_, z_);
      operator_norm_ = std::max(operator_norm_, detail::norm(z_) / detail::norm(q_));
      first = false;
    }
    const double before = now.preconditioned * now.preconditioned;
    detail::add_scaled(x, before / curvature, p_);
    detail::add_scaled(r_, -before / curvature, q_);
    now = precondition_residual(op);
    if (!std::isfinite(now.preconditioned)) return false;
    detail::scale_and_add(p_, now.preconditioned * now.preconditioned / before, z_);
    ++iterations;
  }
  return true;
}

}}  // namespace palpate
