// Accuracy of a solver: condition estimate and probe solve.
#pragma once

#include <palpate/linear/detail/any_solver.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Estimate of |K^-1|_1 for symmetric K (Hager 1984, Higham 1988; usually within a factor 3, always a lower bound) from
/// two to ten solves, usually four to six. Allocates; NaN when a solve is not finite.
double inverse_norm_estimate(SolverView solver);

/// Lower bound of |K|_2 |K^-1|_2 from ten steps of the power method and two of inverse iteration: for solvers whose
/// solves are expensive. Usually within a factor 10. Allocates; NaN when a solve is not finite.
double condition_by_iteration(const OperatorView& op, SolverView solver);

}  // namespace detail

/// Solves K x = K t for a fixed random t and returns |x - t| / |t|: the measured accuracy, independent of residuals.
/// Infinity when the solution is not finite. Allocates.
double probe_error(const detail::OperatorView& op, detail::SolverView solver);

namespace detail {

/// Accuracy of a solver for the softest motion of an operator.
struct SoftestMotion {
  double error = 0.0;  ///< relative, of a solve whose exact solution is this motion; 1 when the motion is lost
  Index largest = -1;  ///< its largest entry
};

/// Finds the softest motion by inverse iteration from a fixed random start, and solves for it as `probe_error` does.
/// In a random solution one motion has only a share of 1 / sqrt(n); if rounding loses a single motion, this test shows
/// the full loss. Infinity when a solution is not finite. Three solves; allocates.
SoftestMotion probe_softest_motion(const OperatorView& op, SolverView solver);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/condition.ipp>
#endif
