// Definitions of components.hpp.
#pragma once

#include <palpate/mesh/detail/components.hpp>

#include <algorithm>
#include <numeric>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Root of a node's tree, with path halving.
inline NodeId find_root(std::vector<NodeId>& parent, NodeId node) noexcept {
  const auto at = [&](NodeId i) -> NodeId& { return parent[static_cast<std::size_t>(i)]; };
  while (at(node) != node) node = at(node) = at(at(node));
  return node;
}

}  // namespace detail

PALPATE_INLINE MeshComponents connected_components(const MeshRef& mesh) {
  const auto n = static_cast<std::size_t>(mesh.node_count);
  std::vector<NodeId> parent(n);
  std::iota(parent.begin(), parent.end(), NodeId{0});
  std::vector<char> used(n, 0);
  for (Index e = 0; e < mesh.element_count; ++e) {
    const NodeId* nodes = mesh.nodes_of(e);
    NodeId root = detail::find_root(parent, nodes[0]);
    for (int a = 0; a < mesh.element.nodes; ++a) {
      used[static_cast<std::size_t>(nodes[a])] = 1;
      const NodeId other = detail::find_root(parent, nodes[a]);
      // The lower id becomes the root, so that components are numbered by their lowest node below.
      parent[static_cast<std::size_t>(std::max(root, other))] = std::min(root, other);
      root = std::min(root, other);
    }
  }
  MeshComponents components{std::vector<NodeId>(n, -1), 0};
  for (std::size_t i = 0; i < n; ++i) {
    if (used[i] == 0) continue;
    const auto root = static_cast<std::size_t>(detail::find_root(parent, static_cast<NodeId>(i)));
    components.of_node[i] = root == i ? static_cast<NodeId>(components.count++) : components.of_node[root];
  }
  return components;
}

}}  // namespace palpate
