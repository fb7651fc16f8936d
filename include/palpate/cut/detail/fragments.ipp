// Definitions of fragments.hpp.
#pragma once

#include <palpate/cut/detail/fragments.hpp>
#include <palpate/mesh/detail/rigid_modes.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE int free_mode_count(std::span<const Vector3> positions, std::span<const NodeId> nodes,
                                   std::span<const std::uint8_t> constrained) {
  std::vector<NodeId> supports;
  for (const NodeId node : nodes)
    if ((constrained[static_cast<std::size_t>(node)] & 7u) != 0) supports.push_back(node);
  if (supports.empty()) return 6;
  const detail::RigidFrame frame(positions, nodes, constrained);
  return static_cast<int>(detail::free_motions(positions, supports, constrained, frame).size());
}

}}  // namespace palpate
