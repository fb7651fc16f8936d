// Direct solver for a matrix whose values change and whose pattern is constant.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Precision in which solves read a factor. Single: half the time, a relative error of about 1e-6 times the condition,
/// half more memory. For preconditioners.
enum class FactorScalar { double_precision, single_precision };

/// Factorises K = L L^T repeatedly on one analysis, into the same memory, for iterations and time steps. Neither
/// factorising nor solving allocates or throws. Not thread safe; neither copied nor moved.
class RepeatedCholesky {
 public:
  /// Allocates the memory that the analysis predicted. Throws too_large.
  explicit RepeatedCholesky(CholeskyAnalysis analysis, const SetupLimits& limits = {},
                            FactorScalar scalar = FactorScalar::double_precision);
  ~RepeatedCholesky();
  RepeatedCholesky(const RepeatedCholesky&) = delete;
  RepeatedCholesky& operator=(const RepeatedCholesky&) = delete;

  /// Returns false, without a factor, when a pivot fails: the matrix is not positive definite, or not finite. The
  /// matrix must have the analysed pattern.
  bool factorise(const SparseLower& lower) noexcept;
  /// True when the last matrix was factorised.
  bool ready() const noexcept { return ready_; }

  Index size() const noexcept { return analysis_.size(); }
  const CholeskyAnalysis& analysis() const noexcept { return analysis_; }
  std::size_t bytes() const noexcept;

  /// x = K^-1 b; b and x may be the same vector. Without a factor: not converged, x unchanged.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept;

 private:
  struct Factor;

  CholeskyAnalysis analysis_;
  std::unique_ptr<Factor> factor_;
  bool ready_ = false;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/repeated_cholesky.ipp>
#endif
