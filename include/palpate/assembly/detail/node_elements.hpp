// Elements around each node.
#pragma once

#include <palpate/assembly/detail/node_lists.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <span>

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/node_elements.ipp>
#endif
