// Definitions of warped_compliance.hpp.
#pragma once

#include <palpate/model/moving/detail/warped_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void WarpedCompliance::find_bounds() {
  bound_.assign(count_, 0.0);
  for (std::size_t j = 0; j < count_; ++j) {
    for (std::size_t i = 0; i < count_; ++i) bound_[j] = std::max(bound_[j], at_rest(i, j).norm());
    floor_ = std::max(floor_, 1e-9 * bound_[j]);
  }
  if (floor_ == 0.0) floor_ = 1e-9;
}

}}  // namespace palpate
