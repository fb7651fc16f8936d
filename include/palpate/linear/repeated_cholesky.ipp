// Definitions of repeated_cholesky.hpp.
#pragma once

#include <palpate/linear/detail/front_factorisation.hpp>
#include <palpate/linear/detail/front_sweeps.hpp>
#include <palpate/linear/detail/single_sweeps.hpp>
#include <palpate/linear/repeated_cholesky.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(LinearSolver<RepeatedCholesky>);

struct RepeatedCholesky::Factor {
  Factor(const CholeskyAnalysis& analysis, FactorScalar scalar)
      : values(analysis.tree().factor_size + padding),
        factorisation(analysis, values.data(), SparseCholesky::pivot_threshold),
        sweeps(analysis.tree(), values.data(), analysis.front_count()) {
    std::fill_n(values.data() + values.size() - padding, padding, 0.0);
    if (scalar == FactorScalar::single_precision)
      single = std::make_unique<detail::SingleSweeps>(analysis.tree(), analysis.front_count());
  }

  static constexpr Index padding = 64;  // zeros after the factor, for kernels that read past its end
  detail::BigArray values;
  detail::FrontFactorisation factorisation;
  detail::FrontSweeps sweeps;
  std::unique_ptr<detail::SingleSweeps> single;  // used instead, if present
};

PALPATE_INLINE RepeatedCholesky::RepeatedCholesky(CholeskyAnalysis analysis, const SetupLimits& limits,
                                                  FactorScalar scalar)
    : analysis_(std::move(analysis)) {
  const double more =
      scalar == FactorScalar::single_precision ? 4.0 * static_cast<double>(analysis_.tree().factor_size) : 0.0;
  limits.require_memory(analysis_.repeated_peak_bytes() + more, "the sparse factor");
  factor_ = std::make_unique<Factor>(analysis_, scalar);
}
PALPATE_INLINE RepeatedCholesky::~RepeatedCholesky() = default;

PALPATE_INLINE bool RepeatedCholesky::factorise(const SparseLower& lower) noexcept {
  factor_->factorisation.take(lower);
  ready_ = factor_->factorisation.try_eliminate();
  if (ready_ && factor_->single) factor_->single->copy(factor_->values.data());
  return ready_;
}

PALPATE_INLINE std::size_t RepeatedCholesky::bytes() const noexcept {
  return factor_->values.bytes() + (factor_->single ? factor_->values.bytes() / 2 : 0);
}

PALPATE_INLINE SolveReport RepeatedCholesky::solve_into(const VectorX& b, VectorX& x) noexcept {
  if (!ready_) return {false, 0, std::numeric_limits<double>::quiet_NaN()};
  if (factor_->single) {
    factor_->single->solve(b.data(), x.data());
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  }
  detail::FrontSweeps& sweeps = factor_->sweeps;
  sweeps.scatter(b.data());
  sweeps.forward_all();
  sweeps.backward_all();
  sweeps.gather(x.data());
  return {true, 0, std::numeric_limits<double>::quiet_NaN()};
}

}}  // namespace palpate
