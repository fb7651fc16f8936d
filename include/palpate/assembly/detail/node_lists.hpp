// Numbers of items listed by node.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <numeric>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate
