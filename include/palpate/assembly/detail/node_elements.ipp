// Definitions of node_elements.hpp.
#pragma once

#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/core/setup_error.hpp>

#include <limits>
#include <span>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE NodeElements::NodeElements(const MeshRef& mesh) {
  if (mesh.element_count > std::numeric_limits<NodeId>::max())
    raise(SetupErrorKind::count_too_large, "the mesh has " + std::to_string(mesh.element_count) + " elements");
  lists_ = NodeLists(mesh.element_count, mesh.node_count, [&](Index e) {
    return std::span(mesh.nodes_of(e), static_cast<std::size_t>(mesh.element.nodes));
  });
}

}}  // namespace palpate
