// Direct solver for a matrix whose values change and whose pattern stays.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// K = L L^T again and again on one analysis, into the same memory: what an iteration or a time step needs. Neither
/// factorising nor solving allocates or throws. Not to be used from two threads at once; neither copied nor moved.
class RepeatedCholesky {
 public:
  /// Allocates what the analysis predicted. Throws too_large.
  explicit RepeatedCholesky(CholeskyAnalysis analysis, const SetupLimits& limits = {});
  ~RepeatedCholesky();
  RepeatedCholesky(const RepeatedCholesky&) = delete;
  RepeatedCholesky& operator=(const RepeatedCholesky&) = delete;

  /// False, and no factor, when a pivot fails: the matrix is not positive definite, or not finite. It must have the
  /// pattern that was analysed.
  bool factorise(const SparseLower& lower) noexcept;
  /// True when the last matrix was factorised.
  bool ready() const noexcept { return ready_; }

  Index size() const noexcept { return analysis_.size(); }
  const CholeskyAnalysis& analysis() const noexcept { return analysis_; }
  std::size_t bytes() const noexcept;

  /// x = K^-1 b; b and x may be the same vector. Not converged, and x unchanged, without a factor.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept;

 private:
  struct Factor;

  CholeskyAnalysis analysis_;
  std::unique_ptr<Factor> factor_;
  bool ready_ = false;
};

static_assert(LinearSolver<RepeatedCholesky>);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/repeated_cholesky.ipp>
#endif
