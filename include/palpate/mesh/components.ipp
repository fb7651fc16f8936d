// Definitions of components.hpp.
#pragma once

#include <palpate/mesh/components.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE NodeId find_root(std::vector<NodeId>& parent, NodeId node) noexcept {
  const auto at = [&](NodeId i) -> NodeId& { return parent[static_cast<std::size_t>(i)]; };
  while (at(node) != node) node = at(node) = at(at(node));
  return node;
}

}}}  // namespace palpate::detail
