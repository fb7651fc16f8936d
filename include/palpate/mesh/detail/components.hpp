// Connected components of a mesh.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The parts of a mesh that share no node, numbered from zero in the order of their lowest node; -1 marks a node that
/// no element uses.
struct MeshComponents {
  std::vector<NodeId> of_node;  ///< component of each node
  Index count = 0;
};

/// Components by shared nodes. Indices must be in range. Union-find: practically O(nodes + elements), allocates.
MeshComponents connected_components(const MeshRef& mesh);

/// The same for any mesh.
template <Element E, MeshOf<E> M>
MeshComponents connected_components(const M& mesh) {
  return connected_components(detail::plain_view<E>(mesh).mesh);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/components.ipp>
#endif
