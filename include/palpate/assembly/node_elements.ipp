// Definitions of node_elements.hpp.
#pragma once

#include <palpate/assembly/node_elements.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::span<const NodeId> NodeElements::of(Index node) const noexcept {
  const auto i = static_cast<std::size_t>(node);
  return {element_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
}

}}  // namespace palpate
