// Improves a separator by moving single nodes (Fiduccia and Mattheyses 1982, in the vertex form of Ashcraft and Liu).
#pragma once

#include <palpate/linear/detail/part_lists.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Moves nodes from a separator to either side, which draws their neighbours on the other side into it. Takes the best
/// gain first, accepts some losses, and keeps the best state. O(separator x neighbours x log) per pass.
class SeparatorRefinement {
 public:
  explicit SeparatorRefinement(PartLists& lists) : lists_(lists), moved_(lists.graph->nodes(), 0) {}

  /// Improves `side` and returns the new sizes.
  std::array<Index, 3> refine(const Part& part, std::array<Index, 3> sizes) {
    part_ = part;
    sizes_ = sizes;
    for (int pass = 0; pass < 6; ++pass)
      if (!improve()) break;
    return sizes_;
  }

 private:
  struct Move {
    NodeId gain, node;
    Side to;
    bool operator<(const Move& o) const noexcept { return gain != o.gain ? gain < o.gain : node < o.node; }
  };
  struct Change {
    NodeId node;
    Side before;
  };

  static Side other(Side s) noexcept { return s == side_first ? side_second : side_first; }
  double score() const noexcept { return separator_score(sizes_, part_.size()); }

  /// Change of the separator when v moves to a side: nodes that leave it minus nodes drawn in.
  NodeId gain(NodeId v, Side to) const noexcept {
    const NodeGraph& g = *lists_.graph;
    NodeId drawn = 0;
    for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
      const NodeId u = g.neighbour[p];
      drawn += lists_.place[u].label == part_.label && lists_.side[u] == other(to) ? 1 : 0;
    }
    return 1 - drawn;
  }
  void offer(NodeId v) {
    if (moved_[v] == pass_) return;
    for (Side to : {side_first, side_second}) {
      heap_.push_back({gain(v, to), v, to});
      std::push_heap(heap_.begin(), heap_.end());
    }
  }
  void change(NodeId v, Side to) {
    changes_.push_back({v, lists_.side[v]});
    --sizes_[lists_.side[v]];
    ++sizes_[to];
    lists_.side[v] = to;
  }
  /// Moves v, draws its neighbours in, and queues the nodes whose gain has changed.
  void move(NodeId v, Side to) {
    const NodeGraph& g = *lists_.graph;
    moved_[v] = pass_;
    change(v, to);
    for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
      const NodeId u = g.neighbour[p];
      if (lists_.place[u].label != part_.label || lists_.side[u] != other(to)) continue;
      change(u, side_separator);
      offer(u);
      for (Index q = g.start[u]; q < g.start[u + 1]; ++q) {
        const NodeId w = g.neighbour[q];
        if (lists_.place[w].label == part_.label && lists_.side[w] == side_separator && w != u) offer(w);
      }
    }
  }

  bool improve() {
    ++pass_;
    heap_.clear();
    changes_.clear();
    for (Index i = part_.begin; i < part_.end; ++i)
      if (lists_.side[lists_.sorted[0][i]] == side_separator) offer(lists_.sorted[0][i]);
    const Index patience = 20 + sizes_[2] / 8;
    const double start = score();
    double best = start;
    std::size_t kept = 0;
    for (Index idle = 0; idle < patience && !heap_.empty();) {
      std::pop_heap(heap_.begin(), heap_.end());
      const Move c = heap_.back();
      heap_.pop_back();
      if (lists_.side[c.node] != side_separator || moved_[c.node] == pass_ || gain(c.node, c.to) != c.gain) continue;
      if (5 * (sizes_[other(c.to)] + c.gain - 1) < part_.size()) continue;  // too unbalanced
      move(c.node, c.to);
      ++idle;
      if (score() >= best) continue;
      best = score();
      kept = changes_.size();
      idle = 0;
    }
    for (; changes_.size() > kept; changes_.pop_back()) {
      const Change& c = changes_.back();
      --sizes_[lists_.side[c.node]];
      ++sizes_[c.before];
      lists_.side[c.node] = c.before;
    }
    return best < start;
  }

  PartLists& lists_;
  Part part_;
  std::array<Index, 3> sizes_{};
  IndexedVector<int> moved_;  // per node the last pass that moved it
  std::vector<Move> heap_;
  std::vector<Change> changes_;
  int pass_ = 0;
};

}}}  // namespace palpate::detail
