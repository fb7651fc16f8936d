// Connected components of a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The parts of a mesh that share no node, numbered from zero in the order of their lowest node; -1 marks a node that
/// no element uses.
struct MeshComponents {
  std::vector<NodeId> of_node;  ///< component of each node
  Index count = 0;
};

/// Root of a node's tree, with path halving.
inline NodeId find_root(std::vector<NodeId>& parent, NodeId node) noexcept {
  const auto at = [&](NodeId i) -> NodeId& { return parent[static_cast<std::size_t>(i)]; };
  while (at(node) != node) node = at(node) = at(at(node));
  return node;
}

/// Components by shared nodes. Indices must be in range. Union-find: practically O(nodes + elements), allocates.
inline MeshComponents connected_components(const MeshRef& mesh) {
  const auto n = static_cast<std::size_t>(mesh.node_count);
  std::vector<NodeId> parent(n);
  std::iota(parent.begin(), parent.end(), NodeId{0});
  std::vector<char> used(n, 0);
  for (Index e = 0; e < mesh.element_count; ++e) {
    const NodeId* nodes = mesh.nodes_of(e);
    NodeId root = find_root(parent, nodes[0]);
    for (int a = 0; a < mesh.element.nodes; ++a) {
      used[static_cast<std::size_t>(nodes[a])] = 1;
      const NodeId other = find_root(parent, nodes[a]);
      // The lower id becomes the root, so that components are numbered by their lowest node below.
      parent[static_cast<std::size_t>(std::max(root, other))] = std::min(root, other);
      root = std::min(root, other);
    }
  }
  MeshComponents components{std::vector<NodeId>(n, -1), 0};
  for (std::size_t i = 0; i < n; ++i) {
    if (used[i] == 0) continue;
    const auto root = static_cast<std::size_t>(find_root(parent, static_cast<NodeId>(i)));
    components.of_node[i] = root == i ? static_cast<NodeId>(components.count++) : components.of_node[root];
  }
  return components;
}

/// The same for any mesh.
template <Element E, MeshOf<E> M>
MeshComponents connected_components(const M& mesh) {
  return connected_components(plain_view<E>(mesh).mesh);
}

}}}  // namespace palpate::detail
