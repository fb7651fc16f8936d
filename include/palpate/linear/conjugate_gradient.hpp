// Iterative solver for symmetric positive definite operators.
#pragma once

#include <palpate/concepts/linear_solver.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// When to stop.
struct ConjugateGradientParameters {
  double tolerance = 1e-12;    ///< of the true relative residual |b - K x| / |b|
  int maximum_iterations = 0;  ///< 0: three times the size, at least 100
};

/// Preconditioned conjugate gradients. Needs products with K only; nothing is inverted and there is no time step (the
/// thesis says otherwise in 3.6.2, see docs/thesis.md). The recursive residual drifts, so convergence is decided by the
/// recomputed one, with restarts until it no longer improves. Workspaces are owned: `solve_into` does not allocate.
class ConjugateGradientSolver {
 public:
  ConjugateGradientSolver() = default;
  explicit ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters = {})
      : parameters_(parameters), r_(size), z_(size), p_(size), q_(size) {
    if (parameters_.maximum_iterations <= 0)
      parameters_.maximum_iterations = static_cast<int>(std::max<Index>(100, 3 * size));
  }

  std::size_t bytes() const noexcept { return static_cast<std::size_t>(4 * r_.size()) * sizeof(double); }

  /// x = K^-1 b from a zero start. Cost: one product and one preconditioning per iteration, at most
  /// `maximum_iterations`.
  template <SpdOperator Op>
  SolveReport solve_into(const Op& op, const VectorX& b, VectorX& x) noexcept {
    SolveReport report;
    x.setZero();
    const double b_norm = b.norm();
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
      r_ = b - q_;
      report.relative_residual = r_.norm() / b_norm;
      if (report.relative_residual <= parameters_.tolerance) break;
      if (!(report.relative_residual < 0.5 * best) || report.iterations == before)
        break;  // rounding floor, or breakdown
      best = report.relative_residual;
    }
    report.converged = report.relative_residual <= parameters_.tolerance;
    return report;
  }

 private:
  /// Plain CG from residual r_ until the recursive residual is below `goal`.
  template <SpdOperator Op>
  void iterate(const Op& op, double goal, VectorX& x, int& iterations) noexcept {
    op.precondition(r_, z_);
    p_ = z_;
    double rz = r_.dot(z_);
    while (iterations < parameters_.maximum_iterations && r_.norm() > goal) {
      op.apply(p_, q_);
      const double curvature = p_.dot(q_);
      if (!(curvature > 0.0) || !std::isfinite(curvature)) return;
      const double alpha = rz / curvature;
      x.noalias() += alpha * p_;
      r_.noalias() -= alpha * q_;
      op.precondition(r_, z_);
      const double next = r_.dot(z_);
      p_ = z_ + (next / rz) * p_;
      rz = next;
      ++iterations;
    }
  }

  ConjugateGradientParameters parameters_;
  VectorX r_, z_, p_, q_;
};

}}  // namespace palpate
