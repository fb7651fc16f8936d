// Conjugate gradients for a time step: a bounded number of iterations and an estimate of the remaining error.
#pragma once

#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// When to stop.
struct BoundedSolveParameters {
  int maximum_iterations = 50;
  double tolerance = 1e-3;  ///< relative error of the solution, in the energy norm
};
struct BoundedSolveReport {
  bool converged = false;
  int iterations = 0;
  double error = infinity;  ///< relative size of the last update, in the energy norm; infinite before the first
};

/// K x = b by preconditioned conjugate gradients, starting from zero. Every iteration adds alpha r.z to the squared
/// energy norm of x (Hestenes and Stiefel 1952), the norm in which CG is optimal. The solve stops when the last
/// iteration added less than tolerance^2 of the total. This estimates the error before the last iteration; it omits
/// only what further iterations would add. The residual is not recomputed. Owns its workspace; solving does not
/// allocate.
class BoundedConjugateGradient {
 public:
  BoundedConjugateGradient() = default;
  explicit BoundedConjugateGradient(Index size) : r_(size), z_(size), p_(size), q_(size) {}

  /// x stays finite for a finite b: the solve ends at a direction without positive curvature.
  BoundedSolveReport solve_into(const OperatorView& op, const VectorX& b, VectorX& x,
                                const BoundedSolveParameters& parameters) noexcept;

 private:
  VectorX r_, z_, p_, q_;
};

inline BoundedSolveReport BoundedConjugateGradient::solve_into(const OperatorView& op, const VectorX& b, VectorX& x,
                                                               const BoundedSolveParameters& parameters) noexcept {
  BoundedSolveReport report;
  fill(x, 0.0);
  r_ = b;
  op.precondition(r_, z_);
  p_ = z_;
  double rz = dot(r_, z_), whole = 0.0;
  if (rz == 0.0) return {true, 0, 0.0};
  while (!report.converged && report.iterations < parameters.maximum_iterations) {
    op.apply(p_, q_);
    const double alpha = rz / dot(p_, q_);
    if (!(alpha > 0.0 && alpha < infinity && rz < infinity)) return report;
    add_scaled(x, alpha, p_);
    ++report.iterations;
    whole += alpha * rz;
    report.error = std::sqrt(alpha * rz / whole);
    report.converged = report.error <= parameters.tolerance;
    if (report.converged) break;
    add_scaled(r_, -alpha, q_);
    op.precondition(r_, z_);
    const double next = dot(r_, z_);
    scale_and_add(p_, next / rz, z_);
    rz = next;
    if (rz == 0.0) report.converged = true;
  }
  return report;
}

}}}  // namespace palpate::detail
