// Definitions of patch_recovery.hpp.
#pragma once

#include <palpate/post/detail/patch_recovery.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Index NodalStress::column(Index node, int of_region) const noexcept {
  for (Index k = first[static_cast<std::size_t>(node)]; k < first[static_cast<std::size_t>(node) + 1]; ++k)
    if (region[static_cast<std::size_t>(k)] == of_region) return k;
  return -1;
}

PALPATE_INLINE Vector6 NodalStress::at(Index node) const noexcept {
  const Index k = first[static_cast<std::size_t>(node)];
  if (k == first[static_cast<std::size_t>(node) + 1]) return Vector6::Zero();
  return stress.col(k);
}

}}  // namespace palpate
