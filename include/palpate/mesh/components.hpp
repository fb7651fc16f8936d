// Connected components of a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The parts of a mesh that share no node. Numbered from zero by their lowest node; -1 marks a node that no element
/// uses.
struct MeshComponents {
  std::vector<NodeId> of_node;  ///< component of each node
  Index count = 0;
};

namespace detail {

/// Root of a node's tree; halves the path on the way.
NodeId find_root(std::vector<NodeId>& parent, NodeId node) noexcept;

}  // namespace detail

/// Components by shared nodes. Indices must be in range. Union-find: practically O(nodes + elements), allocates.
template <Element E, MeshOf<E> M>
MeshComponents connected_components(const M& mesh) {
  const auto n = static_cast<std::size_t>(mesh.node_count());
  std::vector<NodeId> parent(n);
  std::iota(parent.begin(), parent.end(), NodeId{0});
  std::vector<char> used(n, 0);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    NodeId root = detail::find_root(parent, static_cast<NodeId>(mesh.element_node(e, 0)));
    for (int a = 0; a < E::nodes; ++a) {
      const auto node = static_cast<NodeId>(mesh.element_node(e, a));
      used[static_cast<std::size_t>(node)] = 1;
      const NodeId other = detail::find_root(parent, node);
      // The lower id becomes the root, hence components are numbered by their lowest node below.
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

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/components.ipp>
#endif
