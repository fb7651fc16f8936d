// Iterative solver for symmetric positive definite operators.
#pragma once

#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/operator_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// When to stop.
struct ConjugateGradientParameters {
  double tolerance = 1e-12;    ///< of the true relative residual |b - K x| / |b|
  int maximum_iterations = 0;  ///< 0: three times the size, at least 100
};

/// Preconditioned conjugate gradients. Needs only products with K; nothing is inverted and there is no time step (the
/// thesis, 3.6.2, states otherwise, see docs/thesis.md). The recursive residual drifts, so convergence is decided by
/// the recomputed residual, with restarts until it no longer improves. Owns its workspaces: `solve_into` does not
/// allocate.
class ConjugateGradientSolver {
 public:
  ConjugateGradientSolver() = default;
  explicit ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters = {});

  std::size_t bytes() const noexcept { return static_cast<std::size_t>(4 * r_.size()) * sizeof(double); }

  /// x = K^-1 b, starting from zero. Cost: one product and one preconditioning per iteration, at most
  /// `maximum_iterations`.
  SolveReport solve_into(const OperatorView& op, const VectorX& b, VectorX& x) noexcept;

 private:
  void iterate(const OperatorView& op, double goal, VectorX& x, int& iterations) noexcept;

  ConjugateGradientParameters parameters_;
  VectorX r_, z_, p_, q_;
};

/// Conjugate gradients bound to an operator.
class IterativeSolver {
 public:
  IterativeSolver() = default;
  IterativeSolver(AnyOperator op, ConjugateGradientParameters parameters)
      : op_(std::move(op)), solver_(op_.size(), parameters) {}

  Index size() const noexcept { return op_.size(); }
  std::size_t bytes() const noexcept { return solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solver_.solve_into(op_, b, x); }

 private:
  AnyOperator op_;
  ConjugateGradientSolver solver_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/conjugate_gradient.ipp>
#endif
