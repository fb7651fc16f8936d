// Definitions of nested_dissection.hpp.
#pragma once

#include <palpate/linear/detail/leaf_order.hpp>
#include <palpate/linear/detail/level_order.hpp>
#include <palpate/linear/detail/nested_dissection.hpp>
#include <palpate/linear/detail/separator.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Bisects parts until they are small.
class NestedDissection {
 public:
  static constexpr Index leaf_nodes = 64;

  explicit NestedDissection(const NodeGraph& graph) : graph_(graph), finder_(prepare(graph, lists_)), leaf_(graph) {
    if (graph.positions.empty()) levels_.emplace_back(lists_);
  }

  NodeVector run() {
    Index count = lists_.sorted[0].size();
    order_.resize(count);
    dissect({0, count, 0});
    for (Index v = 0; v < graph_.nodes(); ++v)
      if (graph_.kept[v] != 0) order_.push_back(static_cast<NodeId>(v));
    return std::move(order_);
  }

 private:
  /// Lists the nodes that are not kept, sorted along the axes if there are coordinates.
  static PartLists& prepare(const NodeGraph& graph, PartLists& lists) {
    lists.graph = &graph;
    lists.place.assign(graph.nodes(), NodePlace());
    lists.side.assign(graph.nodes(), side_first);
    std::vector<std::pair<double, NodeId>> keys;
    for (int axis = 0; axis < dissection_axes; ++axis) {
      keys.clear();
      for (Index v = 0; v < graph.nodes(); ++v)
        if (graph.kept[v] == 0)
          keys.emplace_back(graph.positions.empty() ? 0.0 : graph.positions[static_cast<std::size_t>(v)][axis],
                            static_cast<NodeId>(v));
      if (!graph.positions.empty()) std::sort(keys.begin(), keys.end());
      NodeVector& sorted = lists.sorted[static_cast<std::size_t>(axis)];
      for (const auto& [key, v] : keys) {
        sorted.push_back(v);
        lists.place[v].label = 0;
      }
    }
    return lists;
  }

  void dissect(const Part& part) {
    if (part.size() <= leaf_nodes) return finish(part);
    if (!levels_.empty()) levels_.front().sort(part);
    const std::array<Index, 3> sizes = finder_.cut(part);
    if (sizes[0] == 0 || sizes[1] == 0 || 2 * sizes[2] > part.size()) return finish(part);
    for (NodeVector& sorted : lists_.sorted) split(sorted, part, sizes);
    const Part first{part.begin, part.begin + sizes[0], part.label};
    const Part second{first.end, first.end + sizes[1], ++labels_};
    for (Index i = second.begin; i < second.end; ++i) lists_.place[lists_.sorted[0][i]].label = second.label;
    for (Index i = second.end; i < part.end; ++i) {
      order_[i] = lists_.sorted[0][i];
      lists_.place[order_[i]].label = later;
    }
    dissect(first);
    dissect(second);
  }

  /// Moves the nodes of the first side to the front of a list and the separator to its end.
  void split(NodeVector& sorted, const Part& part, const std::array<Index, 3>& sizes) {
    std::array<Index, 3> to{0, sizes[0], sizes[0] + sizes[1]};
    buffer_.resize(part.size());
    for (Index i = part.begin; i < part.end; ++i)
      buffer_[to[static_cast<std::size_t>(lists_.side[sorted[i]])]++] = sorted[i];
    std::copy(buffer_.begin(), buffer_.end(), sorted.begin() + part.begin);
  }

  void finish(const Part& part) {
    for (Index i = part.begin; i < part.end; ++i) order_[i] = lists_.sorted[0][i];
    if (part.size() <= LeafOrder::max_nodes)
      leaf_.order(order_.data() + part.begin, part.size(),
                  [&](NodeId u) { return lists_.place[u].label == later || graph_.kept[u] != 0; });
    for (Index i = part.begin; i < part.end; ++i) lists_.place[order_[i]].label = gone;
  }

  static constexpr NodeId later = -2, gone = -3;  // labels of nodes in separators and in leaves
  const NodeGraph& graph_;
  PartLists lists_;
  SeparatorFinder finder_;
  LeafOrder leaf_;
  std::vector<LevelOrder> levels_;  // empty when there are coordinates
  NodeVector order_, buffer_;
  NodeId labels_ = 0;
};

}  // namespace detail

PALPATE_INLINE detail::NodeVector nested_dissection(const NodeGraph& graph) {
  return detail::NestedDissection(graph).run();
}

}}  // namespace palpate
