// Iterative solver for symmetric positive definite operators.
#pragma once

#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/operator_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// When to stop.
struct ConjugateGradientParameters {
  double tolerance = 1e-15;    ///< of the true relative residual, in the norms below
  int maximum_iterations = 0;  ///< 0: forty times the size, from 100 to 12,000
};

/// Preconditioned conjugate gradients. Needs only products with K; nothing is inverted and there is no time step (the
/// thesis, 3.6.2, states otherwise, see docs/thesis.md). Owns its workspaces: `solve_into` does not allocate.
///
/// The recursive residual drifts from the true one r = b - K x. So x is corrected in rounds, each of which starts from
/// the recomputed r and reduces the recursive one by at most eight digits, until
/// - |r| <= tolerance |b| and |r|_P <= tolerance |b|_P, with |r|_P^2 = r . P^-1 r: the second norm also sees the soft
///   parts of a body with a large contrast of stiffness; or
/// - a round no longer halves |r|_P: the best that rounding allows. This counts as converged when the backward error
///   |r| / (|K| |x| + |b|) is within 1e-12 or the tolerance, with a lower bound of |K| from one more product per round.
/// The default goes on to the limit of rounding, because the error of x can be larger than the residual by the
/// condition of K. `probe_error` measures it.
class ConjugateGradientSolver {
 public:
  ConjugateGradientSolver() = default;
  explicit ConjugateGradientSolver(Index size, ConjugateGradientParameters parameters = {});

  std::size_t bytes() const noexcept { return static_cast<std::size_t>(5 * r_.size()) * sizeof(double); }

  /// x = K^-1 b, starting from zero. Cost: one product and one preconditioning per iteration, at most
  /// `maximum_iterations`.
  SolveReport solve_into(const OperatorView& op, const VectorX& b, VectorX& x) noexcept;

 private:
  struct Norms {
    double plain, preconditioned;
    bool within(double tolerance, const Norms& load) const noexcept {
      return plain <= tolerance * load.plain && preconditioned <= tolerance * load.preconditioned;
    }
  };

  /// Of r_; computes z_ = P^-1 r_.
  Norms precondition_residual(const OperatorView& op) noexcept;
  /// One round, from the residual r_ with norms `start`. False when the iterations are spent, or the curvature is not
  /// positive and finite.
  bool iterate(const OperatorView& op, const Norms& load, const Norms& start, VectorX& x, int& iterations) noexcept;

  ConjugateGradientParameters parameters_;
  double operator_norm_ = 0.0;  // lower bound of |K|
  VectorX r_, z_, p_, q_, best_;
};

/// Conjugate gradients bound to an operator.
class IterativeSolver {
 public:
  IterativeSolver() = default;
  IterativeSolver(AnyOperator op, ConjugateGradientParameters parameters)
      : op_(std::move(op)), solver_(op_.size(), parameters) {}

  Index size() const noexcept { return op_.size(); }
  std::size_t bytes() const noexcept { return op_.bytes() + solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solver_.solve_into(op_, b, x); }

 private:
  AnyOperator op_;
  ConjugateGradientSolver solver_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/conjugate_gradient.ipp>
#endif
