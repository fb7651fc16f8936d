// Concepts of linear solvers.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Result of a solve.
struct SolveReport {
  bool converged = true;
  int iterations = 0;              ///< 0 for direct solvers
  double relative_residual = 0.0;  ///< |b - K x| / |b|, recomputed, not the recursive one; NaN when not computed
};

/// A symmetric positive definite operator on vectors of `size()` entries: `apply` computes y = K x without allocating,
/// `precondition` y = P^-1 x for some cheap P.
template <class Op>
concept SpdOperator = requires(const Op& op, const VectorX& x, VectorX& y) {
  { op.size() } -> std::convertible_to<Index>;
  { op.apply(x, y) } noexcept;
  { op.precondition(x, y) } noexcept;
};

/// A prepared solver: `solve_into` writes x with K x = b. It never allocates once prepared, and must not be called
/// from two threads simultaneously (it owns its workspace). A set-up calls `solve_into(b, x, threads)` where a solver
/// has it: the same on several SetupThreads, which may allocate. Laws: testing/solver_laws.hpp.
template <class S>
concept LinearSolver = requires(S& solver, const VectorX& b, VectorX& x) {
  { solver.size() } -> std::convertible_to<Index>;
  { solver.solve_into(b, x) } noexcept -> std::same_as<SolveReport>;
};

}}  // namespace palpate
