// Conjugate gradients for a time step: a bounded number of iterations and an estimate of the remaining error.
#pragma once

#include <palpate/linear/detail/operator_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/bounded_conjugate_gradient.ipp>
#endif
