// Definitions of touchable.hpp.
#pragma once

#include <palpate/model/touchable.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void sort_unique(std::vector<NodeId>& nodes) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

}}  // namespace palpate
