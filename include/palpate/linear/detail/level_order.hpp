// Orders of the nodes of a graph without coordinates, by distance from its end nodes.
#pragma once

#include <palpate/linear/detail/part_lists.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Sorts a part along three "axes" found by breadth-first search: from one end to the other, from a node far from both
/// ends, and by the difference of the distances from the ends. O(edges) per part.
class LevelOrder {
 public:
  explicit LevelOrder(PartLists& lists) : lists_(lists), near_(lists.graph->nodes()), far_(lists.graph->nodes()) {}

  void sort(const Part& part) {
    NodeId end = lists_.sorted[0][part.begin];
    for (int again = 0; again < 2; ++again) end = search(part, end, near_, lists_.sorted[2]);
    const NodeId other = search(part, end, near_, lists_.sorted[0]);
    search(part, other, far_, lists_.sorted[1]);
    NodeId aside = end;  // the node farthest from both ends
    for (Index i = part.begin; i < part.end; ++i) {
      const NodeId v = lists_.sorted[0][i];
      if (std::min(near_[v], far_[v]) > std::min(near_[aside], far_[aside])) aside = v;
    }
    std::stable_sort(lists_.sorted[1].begin() + part.begin, lists_.sorted[1].begin() + part.end,
                     [&](NodeId a, NodeId b) { return near_[a] - far_[a] < near_[b] - far_[b]; });
    search(part, aside, far_, lists_.sorted[2]);
  }

 private:
  /// Lists the part breadth first from `root` and returns the last node; other components follow at greater distances.
  NodeId search(const Part& part, NodeId root, NodeVector& distance, NodeVector& listed) {
    const NodeGraph& g = *lists_.graph;
    nodes_.clear();
    for (Index i = part.begin; i < part.end; ++i) {
      nodes_.push_back(lists_.sorted[0][i]);
      distance[lists_.sorted[0][i]] = -1;
    }
    Index head = part.begin, tail = part.begin, next = 0;
    listed[tail++] = root;
    distance[root] = 0;
    while (head < part.end) {
      if (head == tail) {  // a new component
        while (distance[nodes_[next]] >= 0) ++next;
        distance[nodes_[next]] = distance[listed[head - 1]] + 1;
        listed[tail++] = nodes_[next];
      }
      const NodeId v = listed[head++];
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodeId u = g.neighbour[p];
        if (lists_.place[u].label != part.label || distance[u] >= 0) continue;
        distance[u] = distance[v] + 1;
        listed[tail++] = u;
      }
    }
    return listed[part.end - 1];
  }

  PartLists& lists_;
  NodeVector near_, far_, nodes_;
};

}}}  // namespace palpate::detail
