// Concepts of linear algebra: operators, solvers, prepared static systems.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Result of a solve.
struct SolveReport {
  bool converged = true;
  int iterations = 0;              ///< 0 for direct solvers
  double relative_residual = 0.0;  ///< |b - K x| / |b|, recomputed, not the recursive one; NaN when not computed
};

namespace detail {

/// A symmetric positive definite operator on vectors of `size()` entries: `apply` computes y = K x without allocating,
/// `precondition` y = P^-1 x for some cheap P.
template <class Op>
concept SpdOperator = requires(const Op& op, const VectorX& x, VectorX& y) {
  { op.size() } -> std::convertible_to<Index>;
  { op.apply(x, y) } noexcept;
  { op.precondition(x, y) } noexcept;
};

}  // namespace detail

/// The stiffness of all dofs of a mesh, constrained ones included (x y z per node). `apply` computes y = K x [N]
/// without allocating; `diagonal_blocks` returns the 3 x 3 block of every node. Laws: testing/assembler_laws.hpp.
template <class K>
concept StiffnessOperator = requires(const K& k, const VectorX& x, VectorX& y) {
  { k.size() } -> std::convertible_to<Index>;
  { k.apply(x, y) } noexcept;
  { k.diagonal_blocks() } -> std::same_as<std::vector<Matrix3>>;
  { k.bytes() } -> std::convertible_to<std::size_t>;
};

/// A prepared solver: `solve_into` writes x with K x = b. It never allocates once prepared, and must not be called
/// from two threads simultaneously (it owns its workspace). A set-up calls `solve_into(b, x, threads)` where a solver
/// has it: the same on several SetupThreads, which may allocate. Laws: testing/solver_laws.hpp.
template <class S>
concept LinearSolver = requires(S& solver, const VectorX& b, VectorX& x) {
  { solver.size() } -> std::convertible_to<Index>;
  { solver.solve_into(b, x) } noexcept -> std::same_as<SolveReport>;
};

/// A prepared static system over the free dofs with some of them kept. `solve_into` gives the exact displacement under
/// any load (loads on condensed dofs included); `compliance_column(j, c)` writes the response of the kept dofs to a
/// unit force on kept dof j. Neither allocates. Law (testing/condensation_laws.hpp): both equal the full solve.
template <class S>
concept StaticSystem = LinearSolver<S> && requires(S& system, Index j, VectorX& column) {
  { system.kept() } -> std::convertible_to<Index>;
  { system.compliance_column(j, column) } noexcept -> std::same_as<SolveReport>;
  { system.bytes() } -> std::convertible_to<std::size_t>;
};

}}  // namespace palpate
