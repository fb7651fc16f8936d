// Definitions of bounded_conjugate_gradient.hpp.
#pragma once

#include <palpate/linear/bounded_conjugate_gradient.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE BoundedSolveReport BoundedConjugateGradient::solve_into(
    const OperatorView& op, const VectorX& b, VectorX& x, const BoundedSolveParameters& parameters) noexcept {
  BoundedSolveReport report;
  detail::fill(x, 0.0);
  r_ = b;
  op.precondition(r_, z_);
  p_ = z_;
  double rz = detail::dot(r_, z_), whole = 0.0;
  if (rz == 0.0) return {true, 0, 0.0};
  while (!report.converged && report.iterations < parameters.maximum_iterations) {
    op.apply(p_, q_);
    const double alpha = rz / detail::dot(p_, q_);
    if (!(alpha > 0.0 && alpha < infinity && rz < infinity)) return report;
    detail::add_scaled(x, alpha, p_);
    ++report.iterations;
    whole += alpha * rz;
    report.error = std::sqrt(alpha * rz / whole);
    report.converged = report.error <= parameters.tolerance;
    if (report.converged) break;
    detail::add_scaled(r_, -alpha, q_);
    op.precondition(r_, z_);
    const double next = detail::dot(r_, z_);
    detail::scale_and_add(p_, next / rz, z_);
    rz = next;
    if (rz == 0.0) report.converged = true;
  }
  return report;
}

}}  // namespace palpate
