// Numbers of items listed by node, and the elements around each node.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// For every node the numbers of the items that contain it, ascending: elements, faces, triangles.
class NodeLists {
 public:
  NodeLists() = default;
  /// `nodes_of(i)`: the nodes of item i, a range. O(nodes of all items), allocates 4 bytes for each of them.
  template <class NodesOf>
  NodeLists(Index items, Index nodes, NodesOf&& nodes_of) : first_(static_cast<std::size_t>(nodes) + 1, 0) {
    for (Index i = 0; i < items; ++i)
      for (const NodeId n : nodes_of(i)) ++first_[static_cast<std::size_t>(n) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    item_.resize(static_cast<std::size_t>(first_.back()));
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (Index i = 0; i < items; ++i)
      for (const NodeId n : nodes_of(i))
        item_[static_cast<std::size_t>(next[static_cast<std::size_t>(n)]++)] = static_cast<NodeId>(i);
  }

  std::span<const NodeId> of(Index node) const noexcept {
    const auto i = static_cast<std::size_t>(node);
    return {item_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
  }

 private:
  std::vector<Index> first_;
  std::vector<NodeId> item_;
};

/// Elements around every node, ascending. O(elements), allocates 4 bytes per node of every element.
class NodeElements {
 public:
  /// Throws count_too_large beyond 2^31 elements.
  explicit NodeElements(const MeshRef& mesh);
  template <Element E>
  explicit NodeElements(const Mesh<E>& mesh) : NodeElements(mesh_ref(mesh)) {}

  std::span<const NodeId> of(Index node) const noexcept { return lists_.of(node); }

 private:
  NodeLists lists_;
};

inline NodeElements::NodeElements(const MeshRef& mesh) {
  if (mesh.element_count > std::numeric_limits<NodeId>::max())
    raise(SetupErrorKind::count_too_large, "the mesh has " + std::to_string(mesh.element_count) + " elements");
  lists_ = NodeLists(mesh.element_count, mesh.node_count, [&](Index e) {
    return std::span(mesh.nodes_of(e), static_cast<std::size_t>(mesh.element.nodes));
  });
}

}}}  // namespace palpate::detail
