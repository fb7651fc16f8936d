// Definitions of single_sweeps.hpp.
#pragma once

#include <palpate/linear/detail/one_front.hpp>
#include <palpate/linear/detail/single_sweeps.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE SingleSweeps::SingleSweeps(const FrontTree& tree, Index fronts)
    : tree_(tree),
      fronts_(fronts),
      factor_(static_cast<std::size_t>(tree.factor_size) + 64),  // kernels read past its end
      values_(static_cast<std::size_t>(tree.place_of_dof.size())),
      local_(static_cast<std::size_t>(LowerPanels::padded(tree.largest_front) + LowerPanels::alignment)) {}

PALPATE_INLINE void SingleSweeps::copy(const double* factor) noexcept {
  for (Index i = 0; i < tree_.factor_size; ++i) factor_[static_cast<std::size_t>(i)] = static_cast<float>(factor[i]);
}

PALPATE_INLINE void SingleSweeps::solve(const double* b, double* x) noexcept {
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
