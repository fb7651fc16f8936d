// Conjugate gradients for a step of time: a bounded number of iterations, and what they leave.
#pragma once

#include <palpate/linear/detail/operator_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// When to stop, and what was left.
struct BoundedSolveParameters {
  int maximum_iterations = 50;
  double tolerance = 1e-3;  ///< of the answer, in the energy norm
};
struct BoundedSolveReport {
  bool converged = false;
  int iterations = 0;
  double error = infinity;  ///< part of the answer that the last iteration added, in the energy norm; before: infinite
};

/// K x = b by preconditioned conjugate gradients from zero. Every iteration adds alpha r.z to the squared energy norm
/// of x (Hestenes and Stiefel 1952), the quantity in which CG is optimal: it stops when the last one added less than
/// tolerance^2 of the whole. That is an estimate of the error before the last iteration, exact but for the iterations
/// not made. No residual is recomputed. Owns its workspace; solving does not allocate.
class BoundedConjugateGradient {
 public:
  BoundedConjugateGradient() = default;
  explicit BoundedConjugateGradient(Index size) : r_(size), z_(size), p_(size), q_(size) {}

  /// x stays finite for a finite b: a direction without positive curvature ends it.
  BoundedSolveReport solve_into(const OperatorView& op, const VectorX& b, VectorX& x,
                                const BoundedSolveParameters& parameters) noexcept;

 private:
  VectorX r_, z_, p_, q_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/bounded_conjugate_gradient.ipp>
#endif
