// Direct solver for a matrix whose values change and whose pattern stays.
#pragma once

#include <palpate/linear/sparse_cholesky.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// K = L L^T again and again on one analysis, into the same memory: what an iteration or a time step needs. Neither
/// factorising nor solving allocates or throws. Not to be used from two threads at once; neither copied nor moved.
class RepeatedCholesky {
 public:
  /// Allocates what the analysis predicted. Throws too_large.
  explicit RepeatedCholesky(CholeskyAnalysis analysis, const SetupLimits& limits = {})
      : analysis_(std::move(analysis)),
        values_(checked(analysis_, limits) + padding),
        factorisation_(analysis_, values_.data()),
        sweeps_(analysis_.tree(), values_.data(), analysis_.front_count()) {
    std::fill_n(values_.data() + values_.size() - padding, padding, 0.0);
  }
  RepeatedCholesky(const RepeatedCholesky&) = delete;
  RepeatedCholesky& operator=(const RepeatedCholesky&) = delete;

  /// False, and no factor, when a pivot fails: the matrix is not positive definite, or not finite. It must have the
  /// pattern that was analysed.
  bool factorise(const SparseLower& lower) noexcept {
    factorisation_.take(lower);
    return ready_ = factorisation_.try_eliminate(SparseCholesky::pivot_threshold);
  }
  /// True when the last matrix was factorised.
  bool ready() const noexcept { return ready_; }

  Index size() const noexcept { return analysis_.size(); }
  const CholeskyAnalysis& analysis() const noexcept { return analysis_; }
  std::size_t bytes() const noexcept { return values_.bytes(); }

  /// x = K^-1 b; b and x may be the same vector. Not converged, and x unchanged, without a factor.
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    if (!ready_) return {false, 0, std::numeric_limits<double>::quiet_NaN()};
    sweeps_.scatter(b.data());
    sweeps_.forward_all();
    sweeps_.backward_all();
    sweeps_.gather(x.data());
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }

 private:
  static constexpr Index padding = 64;  // zeros behind the factor, for kernels that read past its end

  static Index checked(const CholeskyAnalysis& analysis, const SetupLimits& limits) {
    limits.require_memory(analysis.peak_bytes(), "the sparse factor");
    return analysis.tree().factor_size;
  }

  CholeskyAnalysis analysis_;
  detail::BigArray values_;
  detail::FrontFactorisation factorisation_;
  detail::FrontSweeps sweeps_;
  bool ready_ = false;
};

static_assert(LinearSolver<RepeatedCholesky>);

}}  // namespace palpate
