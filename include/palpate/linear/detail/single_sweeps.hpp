// Solves with a multifrontal factor stored in single precision.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/detail/one_front.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

struct FrontTree;

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

}}}  // namespace palpate::detail

