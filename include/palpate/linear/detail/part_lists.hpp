// Parts of a graph during nested dissection.
#pragma once

#include <palpate/linear/detail/node_graph.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A part of the graph: the nodes with `label`, listed in several orders between `begin` and `end`.
struct Part {
  Index begin = 0, end = 0;
  NodeId label = 0;
  Index size() const noexcept { return end - begin; }
};

inline constexpr int dissection_axes = 3;
enum Side : unsigned char { side_first, side_second, side_separator };

/// Position of a node: its rank in the lists of its part, and the label of the part.
struct NodePlace {
  std::array<NodeId, dissection_axes> rank{};  ///< per axis, from the beginning of the part
  NodeId label = -1;                           ///< of the part; negative once the node is ordered
};

/// Nodes of all parts, sorted along each axis within their part.
struct PartLists {
  const NodeGraph* graph = nullptr;
  IndexedVector<NodePlace> place;                  ///< per node
  std::array<NodeVector, dissection_axes> sorted;  ///< per axis
  IndexedVector<Side> side;                        ///< per node, from the last cut
};

/// Cost of a separator: its size first, then the balance of the two sides. In three dimensions halves of 0.4 and 0.6
/// cost about as much as a separator that is some per cent larger.
inline double separator_cost(double separator, double bias) noexcept {
  return (separator + 0.5) * (1.0 + 7.0 * bias * bias);
}
inline double separator_score(const std::array<Index, 3>& sizes, Index all) noexcept {
  return separator_cost(static_cast<double>(sizes[2]),
                        0.5 * static_cast<double>(sizes[0] - sizes[1]) / static_cast<double>(all));
}

}}}  // namespace palpate::detail
