// Definitions of warped_compliance.hpp.
#pragma once

#include <palpate/model/moving/detail/warped_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Matrix3 WarpedCompliance::rotated(const std::vector<Matrix3>& rotation, int i, int j) const noexcept {
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  return rotation[a] * at_rest(a, b) * rotation[b].transpose();
}

PALPATE_INLINE void WarpedCompliance::find_bounds() {
  bound_.assign(count_, 0.0);
  for (std::size_t j = 0; j < count_; ++j) {
    for (std::size_t i = 0; i < count_; ++i) bound_[j] = std::max(bound_[j], at_rest(i, j).norm());
    floor_ = std::max(floor_, 1e-9 * bound_[j]);
  }
  if (floor_ == 0.0) floor_ = 1e-9;
}

}}  // namespace palpate
