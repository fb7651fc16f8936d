// A small set of nodes that cuts a part of a graph in two balanced halves.
#pragma once

#include <palpate/linear/bipartite_cover.hpp>
#include <palpate/linear/node_graph.hpp>

#include <array>

namespace palpate::inline PALPATE_ABI::detail {

/// A part of the graph: the nodes with `label`, listed in several orders between `begin` and `end`.
struct Part {
  Index begin = 0, end = 0;
  NodeId label = 0;
  Index size() const noexcept { return end - begin; }
};

inline constexpr int dissection_axes = 3;
enum Side : char { side_first, side_second, side_separator };

/// Nodes of all parts, sorted along each axis within their part.
struct PartLists {
  const NodeGraph* graph = nullptr;
  NodeVector label;                                ///< per node the part it is in, -1 once ordered
  std::array<NodeVector, dissection_axes> sorted;  ///< per axis
  IndexedVector<char> side;                        ///< per node, of the last cut
};

/// Cuts a part after one of its sorted lists: looks at every position of every list at once, then replaces the layer of
/// nodes at the best ones by a minimum vertex cover of the edges cut. O(edges) and the matching.
class SeparatorFinder {
 public:
  explicit SeparatorFinder(PartLists& lists) : lists_(lists), rank_(lists.graph->nodes()) {}

  /// Fills `side` for the part and returns the number of nodes on the first side, on the second and between.
  std::array<Index, 3> cut(const Part& part) {
    sweep(part);
    Cut best;
    for (int axis = 0; axis < dissection_axes; ++axis)
      for (Cut c : promising(part, axis)) {
        if (c.position <= 0) continue;
        c.score = score(apply(part, c), part);
        if (c.score < best.score) best = c;
        last_ = c;
      }
    if (best.position <= 0) return {part.size(), 0, 0};
    return apply(part, best);
  }

 private:
  struct Cut {
    int axis = 0;
    Index position = 0;  // nodes before the cut
    double score = infinity;
  };

  /// Cost of a separator of s nodes between a and b: size first, balance second. In three dimensions a lopsided cut at
  /// 0.4 : 0.6 costs about as much as a separator larger by 2 %.
  static double weigh(double s, double off_balance) noexcept { return (s + 0.5) * (1.0 + 2.0 * off_balance * off_balance); }
  static double score(const std::array<Index, 3>& sizes, const Part& part) noexcept {
    const double off = 0.5 * static_cast<double>(sizes[0] - sizes[1]) / static_cast<double>(part.size());
    return weigh(static_cast<double>(sizes[2]), off);
  }

  /// For every axis and every cut position, the nodes before the cut with a neighbour behind it, and the reverse.
  void sweep(const Part& part) {
    const NodeGraph& g = *lists_.graph;
    const Index n = part.size();
    for (int axis = 0; axis < dissection_axes; ++axis) {
      const NodeVector& sorted = lists_.sorted[static_cast<std::size_t>(axis)];
      for (Index i = 0; i < n; ++i) rank_[sorted[part.begin + i]][static_cast<std::size_t>(axis)] = static_cast<NodeId>(i);
      before_[static_cast<std::size_t>(axis)].assign(n + 1, 0);
      behind_[static_cast<std::size_t>(axis)].assign(n + 1, 0);
    }
    for (Index i = part.begin; i < part.end; ++i) {
      const NodeId v = lists_.sorted[0][i];
      std::array<NodeId, dissection_axes> low = rank_[v], high = rank_[v];
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodeId u = g.neighbour[p];
        if (lists_.label[u] != part.label) continue;
        for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
          low[axis] = std::min(low[axis], rank_[u][axis]);
          high[axis] = std::max(high[axis], rank_[u][axis]);
        }
      }
      for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
        const NodeId at = rank_[v][axis];
        ++before_[axis][at + 1], --before_[axis][high[axis] + 1];
        ++behind_[axis][low[axis] + 1], --behind_[axis][at + 1];
      }
    }
  }

  /// The best positions along an axis by the layer on the thinner side.
  std::array<Cut, 2> promising(const Part& part, int axis) const noexcept {
    const auto a = static_cast<std::size_t>(axis);
    const Index n = part.size();
    std::array<Cut, 2> best;
    Index before = 0, behind = 0;
    for (Index t = 1; t < n; ++t) {
      before += before_[a][t];
      behind += behind_[a][t];
      const double off = static_cast<double>(t) / static_cast<double>(n) - 0.5;
      if (off < -0.2 || off > 0.2) continue;
      const double score = weigh(static_cast<double>(std::min(before, behind)), off);
      if (score < best[0].score) best[0] = {axis, t, score};
    }
    return best;
  }

  bool is_before(NodeId v, const Cut& c) const noexcept {
    return rank_[v][static_cast<std::size_t>(c.axis)] < c.position;
  }

  /// Sides of the part for one cut.
  std::array<Index, 3> apply(const Part& part, const Cut& c) {
    describe_edges(part, c);
    cover_.solve(right_.size());
    std::array<Index, 3> sizes{c.position, part.size() - c.position, 0};
    const auto take = [&](NodeId v, Index& from) {
      lists_.side[v] = side_separator;
      --from;
      ++sizes[2];
    };
    for (Index i = 0; i < left_.size(); ++i)
      if (cover_.left_in_cover(i)) take(left_[i], sizes[0]);
    for (Index i = 0; i < right_.size(); ++i)
      if (cover_.right_in_cover(i)) take(right_[i], sizes[1]);
    return sizes;
  }

  /// Hands the edges across the cut to the matching, and puts every node on its side.
  void describe_edges(const Part& part, const Cut& c) {
    const NodeGraph& g = *lists_.graph;
    const NodeVector& sorted = lists_.sorted[static_cast<std::size_t>(c.axis)];
    cover_.clear();
    left_.clear();
    right_.clear();
    number_.resize(g.nodes());
    for (Index i = part.begin; i < part.end; ++i) {
      lists_.side[sorted[i]] = i - part.begin < c.position ? side_first : side_second;
      number_[sorted[i]] = -1;
    }
    for (Index i = part.begin; i < part.begin + c.position; ++i) {
      const NodeId v = sorted[i];
      bool cut = false;
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodeId u = g.neighbour[p];
        if (lists_.label[u] != part.label || is_before(u, c)) continue;
        if (number_[u] < 0) {
          number_[u] = static_cast<NodeId>(right_.size());
          right_.push_back(u);
        }
        cover_.add_edge(number_[u]);
        cut = true;
      }
      if (!cut) continue;
      cover_.end_left();
      left_.push_back(v);
    }
  }

  PartLists& lists_;
  IndexedVector<std::array<NodeId, dissection_axes>> rank_;
  std::array<OffsetVector, dissection_axes> before_, behind_;
  BipartiteCover cover_;
  NodeVector left_, right_, number_;
  Cut last_;
};

}  // namespace palpate::inline PALPATE_ABI::detail
