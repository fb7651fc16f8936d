// Elements around each node.
#pragma once

#include <palpate/assembly/detail/node_lists.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <limits>
#include <span>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate
