// How much a solver can be trusted: condition estimate and probe solve.
#pragma once

#include <palpate/linear/detail/operator_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Estimate of |K^-1|_1 for symmetric K from a handful of solves (Hager 1984, Higham 1988; usually within a factor 3,
/// always a lower bound). Allocates; NaN when a solve is not finite.
double inverse_norm_estimate(SolverView solver);

/// Solves K x = K t for a fixed random t and returns |x - t| / |t|: the accuracy left, measured, whatever residuals
/// say. Infinity when the answer is not finite. Allocates.
double probe_error(const OperatorView& op, SolverView solver);

/// What a solver makes of the softest motion of an operator.
struct SoftestMotion {
  double error = 0.0;  ///< relative, of a solve with this motion as its answer; 1 when nothing of it is left
  Index largest = -1;  ///< its largest entry
};

/// Finds the softest motion by inverse iteration from a fixed random start, and solves for it as `probe_error` does. A
/// random answer has only a share of 1 / sqrt(n) of one motion; where a single one is lost to rounding, this shows all
/// of the loss. Infinity when an answer is not finite. Three solves; allocates.
SoftestMotion probe_softest_motion(const OperatorView& op, SolverView solver);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/condition.ipp>
#endif
