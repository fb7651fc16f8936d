// Definitions of repeated_cholesky.hpp.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/front_sweeps.hpp>
#include <palpate/linear/detail/front_work.hpp>
#include <palpate/linear/detail/one_front.hpp>
#include <palpate/linear/detail/pivot_check.hpp>
#include <palpate/linear/repeated_cholesky.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A copy of a factor in single precision: a solve reads half as many bytes. Refers to the tree, which must outlive it.
/// Only the constructor allocates.
class SingleSweeps {
 public:
  SingleSweeps(const FrontTree& tree, Index fronts);

  /// Copies the values of a factor.
  void copy(const double* factor) noexcept;
  /// x = (L L^T)^-1 b; b and x may be the same.
  void solve(const double* b, double* x) noexcept;

 private:
  const FrontTree& tree_;
  Index fronts_;
  std::vector<float> factor_, values_, local_;
};

inline SingleSweeps::SingleSweeps(const FrontTree& tree, Index fronts)
    : tree_(tree),
      fronts_(fronts),
      factor_(static_cast<std::size_t>(tree.factor_size) + 64),  // kernels read past its end
      values_(static_cast<std::size_t>(tree.place_of_dof.size())),
      local_(static_cast<std::size_t>(LowerPanels::padded(tree.largest_front) + LowerPanels::alignment)) {}

inline void SingleSweeps::copy(const double* factor) noexcept {
  for (Index i = 0; i < tree_.factor_size; ++i) factor_[static_cast<std::size_t>(i)] = static_cast<float>(factor[i]);
}

inline void SingleSweeps::solve(const double* b, double* x) noexcept {
  // Scaled to the largest entry, so that no load is too small or too large for single precision.
  double largest = 0.0;
  const auto size = static_cast<Index>(values_.size());
  for (Index i = 0; i < size; ++i) largest = std::max(largest, std::abs(b[i]));
  if (!(largest > 0.0)) largest = 1.0;
  float* const values = values_.data();
  for (Index i = 0; i < size; ++i) values[tree_.place_of_dof[i]] = static_cast<float>(b[i] / largest);
  for (Index f = 0; f < fronts_; ++f) forward_one(tree_, tree_.fronts[f], factor_.data(), values, local_.data());
  for (Index f = fronts_ - 1; f >= 0; --f) backward_one(tree_, tree_.fronts[f], factor_.data(), values, local_.data());
  for (Index i = 0; i < size; ++i) x[i] = largest * static_cast<double>(values[tree_.place_of_dof[i]]);
}

/// Eliminates one front after the other into `factor`.
class FrontFactorisation {
 public:
  FrontFactorisation(const CholeskyAnalysis& analysis, double* factor, double threshold)
      : system_(analysis.tree(), factor, threshold),
        work_(analysis.tree(), analysis.pack_size()),
        workspace_(analysis.tree().workspace_size + 64) {
    for (Index f = 0; f < system_.tree.fronts.size(); ++f)
      system_.updates[f] = workspace_.data() + system_.tree.fronts[f].update;
  }

  /// Refers to the values of a matrix with the analysed pattern; they must stay valid until elimination is done.
  void refer_to(const SparseLower& lower) noexcept { system_.refer_to(lower); }

  /// Eliminates all fronts; returns false when a pivot fails. No allocation.
  bool try_eliminate() noexcept {
    for (Index f = 0; f < system_.tree.fronts.size(); ++f) {
      const Front& front = system_.tree.fronts[f];
      work_.eliminate(system_, f, nullptr);
      for (Index i = front.first; i < front.first + front.pivots; ++i)
        if (!pivot_is_good(system_.pivots.data()[i], system_.diagonal.data()[i], system_.threshold)) return false;
    }
    return true;
  }

 private:
  FrontSystem system_;
  FrontWork work_;
  BigArray workspace_;
};

static_assert(LinearSolver<RepeatedCholesky>);

struct RepeatedCholesky::Factor {
  Factor(const CholeskyAnalysis& analysis, FactorScalar scalar)
      : values(analysis.tree().factor_size + padding),
        factorisation(analysis, values.data(), SparseCholesky::pivot_threshold),
        sweeps(analysis.tree(), values.data(), analysis.front_count()) {
    std::fill_n(values.data() + values.size() - padding, padding, 0.0);
    if (scalar == FactorScalar::single_precision)
      single = std::make_unique<SingleSweeps>(analysis.tree(), analysis.front_count());
  }

  static constexpr Index padding = 64;  // zeros after the factor, for kernels that read past its end
  BigArray values;
  FrontFactorisation factorisation;
  FrontSweeps sweeps;
  std::unique_ptr<SingleSweeps> single;  // used instead, if present
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
  factor_->factorisation.refer_to(lower);
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
  FrontSweeps& sweeps = factor_->sweeps;
  sweeps.scatter(b.data());
  sweeps.forward_all();
  sweeps.backward_all();
  sweeps.gather(x.data());
  return {true, 0, std::numeric_limits<double>::quiet_NaN()};
}

}}}  // namespace palpate::detail
