// Which elements meet in a node.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Elements around every node, ascending. O(elements), allocates 4 bytes per element and node of it.
class NodeElements {
 public:
  /// Throws count_too_large beyond 2^31 elements.
  template <MeshView M>
  explicit NodeElements(const M& mesh) : first_(static_cast<std::size_t>(mesh.node_count()) + 1, 0) {
    const Index count = mesh.element_count();
    if (count > std::numeric_limits<NodeId>::max())
      raise(SetupErrorKind::count_too_large, "the mesh has " + std::to_string(count) + " elements");
    for (Index e = 0; e < count; ++e)
      for (int a = 0; a < M::nodes_per_element; ++a) ++first_[static_cast<std::size_t>(mesh.element_node(e, a)) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    element_.resize(static_cast<std::size_t>(first_.back()));
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (Index e = 0; e < count; ++e)
      for (int a = 0; a < M::nodes_per_element; ++a)
        element_[static_cast<std::size_t>(next[static_cast<std::size_t>(mesh.element_node(e, a))]++)] =
            static_cast<NodeId>(e);
  }

  std::span<const NodeId> of(Index node) const noexcept;

 private:
  std::vector<Index> first_;
  std::vector<NodeId> element_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/node_elements.ipp>
#endif
