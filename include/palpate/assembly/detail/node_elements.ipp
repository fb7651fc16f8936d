// Definitions of node_elements.hpp.
#pragma once

#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/core/setup_error.hpp>

#include <limits>
#include <numeric>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE NodeElements::NodeElements(const MeshRef& mesh)
    : first_(static_cast<std::size_t>(mesh.node_count) + 1, 0) {
  const Index count = mesh.element_count;
  if (count > std::numeric_limits<NodeId>::max())
    raise(SetupErrorKind::count_too_large, "the mesh has " + std::to_string(count) + " elements");
  const NodeId* const end = mesh.nodes_of(count);
  for (const NodeId* node = mesh.connectivity; node != end; ++node) ++first_[static_cast<std::size_t>(*node) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  element_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  const NodeId* node = mesh.connectivity;
  for (Index e = 0; e < count; ++e)
    for (int a = 0; a < mesh.element.nodes; ++a)
      element_[static_cast<std::size_t>(next[static_cast<std::size_t>(*node++)]++)] = static_cast<NodeId>(e);
}

PALPATE_INLINE std::span<const NodeId> NodeElements::of(Index node) const noexcept {
  const auto i = static_cast<std::size_t>(node);
  return {element_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
}

}}  // namespace palpate
