// Definitions of conjugate_gradient.hpp.
#pragma once

#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<IterativeSolver>);

PALPATE_INLINE ConjugateGradientSolver::ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters)
    : parameters_(parameters), r_(size), z_(size), p_(size), q_(size) {
  if (parameters_.maximum_iterations <= 0)
    parameters_.maximum_iterations = static_cast<int>(std::max<Index>(100, 3 * size));
}

PALPATE_INLINE SolveReport ConjugateGradientSolver::solve_into(const OperatorView& op, const VectorX& b,
                                                               VectorX& x) noexcept {
  SolveReport report;
  detail::fill(x, 0.0);
  const double b_norm = detail::norm(b);
  if (!(b_norm > 0.0) || !std::isfinite(b_norm)) {
    report.converged = b_norm == 0.0;
    return report;
  }
  r_ = b;
  double best = infinity;
  while (report.iterations < parameters_.maximum_iterations) {
    const int before = report.iterations;
    iterate(op, 0.5 * parameters_.tolerance * b_norm, x, report.iterations);
    op.apply(x, q_);
    detail::subtract(b, q_, r_);
    report.relative_residual = detail::norm(r_) / b_norm;
    if (report.relative_residual <= parameters_.tolerance) break;
    if (!(report.relative_residual < 0.5 * best) || report.iterations == before) break;  // rounding floor, or breakdown
    best = report.relative_residual;
  }
  report.converged = report.relative_residual <= parameters_.tolerance;
  return report;
}

/// Plain CG from residual r_ until the recursive residual is below `goal`.
PALPATE_INLINE void ConjugateGradientSolver::iterate(const OperatorView& op, double goal, VectorX& x,
                                                     int& iterations) noexcept {
  op.precondition(r_, z_);
  p_ = z_;
  double rz = detail::dot(r_, z_);
  while (iterations < parameters_.maximum_iterations && detail::norm(r_) > goal) {
    op.apply(p_, q_);
    const double curvature = detail::dot(p_, q_);
    if (!(curvature > 0.0) || !std::isfinite(curvature)) return;
    const double alpha = rz / curvature;
    detail::add_scaled(x, alpha, p_);
    detail::add_scaled(r_, -alpha, q_);
    op.precondition(r_, z_);
    const double next = detail::dot(r_, z_);
    detail::scale_and_add(p_, next / rz, z_);
    rz = next;
    ++iterations;
  }
}

}}  // namespace palpate
