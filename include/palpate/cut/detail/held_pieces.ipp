// Definitions of held_pieces.hpp.
#pragma once

#include <palpate/cut/detail/held_pieces.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE int free_mode_count(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                                   std::span<const std::uint8_t> constrained) {
  std::vector<NodeId> held;
  for (const NodeId node : nodes)
    if ((constrained[static_cast<std::size_t>(node)] & 7u) != 0) held.push_back(node);
  if (held.empty()) return 6;
  const detail::RigidFrame frame(positions, nodes, constrained);
  return static_cast<int>(detail::free_motions(positions, held, constrained, frame).size());
}

}}  // namespace palpate
