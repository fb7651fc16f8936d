// Finds a small set of nodes that separates a part of a graph into two balanced halves.
#pragma once

#include <palpate/linear/detail/flow_separator.hpp>
#include <palpate/linear/detail/part_lists.hpp>
#include <palpate/linear/detail/separator_refinement.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

using Directions = std::array<Vector3, dissection_axes>;

/// The diagonals of a cube's faces and of the cube, and two more. Separators of a round body are seldom along an axis.
inline const std::array<Directions, 4>& oblique_directions() {
  static const std::array<Directions, 4> all{Directions{Vector3(0, 1, 1), Vector3(1, 0, 1), Vector3(1, 1, 0)},
                                             Directions{Vector3(0, 1, -1), Vector3(-1, 0, 1), Vector3(1, -1, 0)},
                                             Directions{Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1)},
                                             Directions{Vector3(-1, -1, 1), Vector3(2, 1, 0), Vector3(-1, 2, 0)}};
  return all;
}

/// Replaces the sorted lists of a part by lists along three directions until its destruction. Needs coordinates.
class OrientedLists {
 public:
  OrientedLists(PartLists& lists, const Part& part, const Directions& directions) : lists_(lists), part_(part) {
    std::vector<std::pair<double, NodeId>> keys(static_cast<std::size_t>(part.size()));
    for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
      const auto begin = lists.sorted[axis].begin() + part.begin, end = lists.sorted[axis].begin() + part.end;
      axes_[axis].assign(begin, end);
      const Vector3& d = directions[axis];
      std::transform(begin, end, keys.begin(), [&](NodeId v) {
        const Vector3& x = lists.graph->positions[static_cast<std::size_t>(v)];
        return std::pair(d[0] * x[0] + d[1] * x[1] + d[2] * x[2], v);
      });
      std::sort(keys.begin(), keys.end());
      std::transform(keys.begin(), keys.end(), begin, [](const auto& key) { return key.second; });
    }
  }
  OrientedLists(const OrientedLists&) = delete;
  OrientedLists& operator=(const OrientedLists&) = delete;
  ~OrientedLists() {
    for (std::size_t axis = 0; axis < dissection_axes; ++axis)
      std::copy(axes_[axis].begin(), axes_[axis].end(), lists_.sorted[axis].begin() + part_.begin);
  }

 private:
  PartLists& lists_;
  Part part_;
  std::array<std::vector<NodeId>, dissection_axes> axes_;
};

/// Cuts a part at a position of one of its sorted lists. Scans every position of every list in one sweep, then
/// replaces the layer of nodes at the best positions by a minimum vertex cover of the cut edges. In a large part, where
/// most of the operations of a factorisation are, it also looks along oblique directions, and takes the smallest
/// separator in a wide band about each cut. O(edges) plus the matching and the flow.
class SeparatorFinder {
 public:
  explicit SeparatorFinder(PartLists& lists)
      : lists_(lists),
        refinement_(lists),
        flow_(lists),
        reach_(lists.graph->nodes()),
        number_(lists.graph->nodes(), -1) {}

  /// Fills `side` for the part and returns the number of nodes on the first side, on the second side and in the
  /// separator.
  std::array<Index, 3> cut(const Part& part) {
    sizes_ = {part.size(), 0, 0};
    lowest_ = lowest_cover_ = infinity;
    const bool large = part.size() >= worth_refining;
    look(part, large);
    if (lowest_ == infinity || !large) return sizes_;
    if (!is_small(part) && !lists_.graph->positions.empty())
      for (const Directions& directions : oblique_directions()) {
        const OrientedLists along(lists_, part, directions);
        look(part, large);
      }
    return refinement_.refine(part, sizes_);
  }

 private:
  struct Cut {
    int axis = 0;
    Index position = 0;  // nodes before the cut
    double score = infinity;
  };
  using Ranks = std::array<NodeId, dissection_axes>;
  static constexpr double worth_a_look = 1.5;  // a cover is hardly ever smaller than its layer by a larger factor
  static constexpr Index worth_refining = 1500;
  static constexpr double worth_widening = 1.15;  // a wide band seldom reduces a separator by a larger factor
  static constexpr double largest_bias = 0.2;     // cuts from 0.3 : 0.7 to 0.7 : 0.3
  static constexpr double widest_band = 0.15;     // of the nodes, on either side of a cut

  /// Keeps the best separator along the present lists if it is better than those before.
  void look(const Part& part, bool wide) {
    sweep(part);
    std::array<Cut, dissection_axes> cuts = promising(part);
    double thinnest = infinity;
    for (const Cut& c : cuts) thinnest = std::min(thinnest, c.score);
    for (Cut& c : cuts) {
      if (c.position <= 0 || c.score > worth_a_look * thinnest) continue;
      const std::array<Index, 3> sizes = cover(part, c);
      c.score = separator_score(sizes, part.size());
      lowest_cover_ = std::min(lowest_cover_, c.score);
      if (keep(part, sizes)) mark(part, c);
    }
    if (!wide) return;
    for (const Cut& c : cuts)
      if (c.position > 0 && c.score <= worth_widening * lowest_cover_) widen(part, c);
  }

  /// True when the separator is hardly larger than a plane across a cube of nodes: there is little to gain.
  bool is_small(const Part& part) const noexcept {
    return lowest_ <= 1.02 * std::pow(static_cast<double>(part.size()), 2.0 / 3.0);
  }

  /// True when the separator is better than those before.
  bool keep(const Part& part, const std::array<Index, 3>& sizes) noexcept {
    const double score = separator_score(sizes, part.size());
    if (score >= lowest_) return false;
    lowest_ = score;
    sizes_ = sizes;
    return true;
  }

  /// The smallest separators in two bands about a cut.
  void widen(const Part& part, const Cut& c) {
    const auto axis = static_cast<std::size_t>(c.axis);
    const auto all = static_cast<double>(part.size());
    const Index outside = part.size() / 5;  // that any side keeps
    for (const double width : {widest_band, 0.5 * widest_band}) {
      const auto band = static_cast<Index>(width * all);
      const Index first = std::max(outside, c.position - band);
      const Index last = std::min(part.size() - outside, c.position + band);
      const std::array<Index, 3> sizes = flow_.cut(part, axis, first, last);
      if (sizes[1] > 0 && keep(part, sizes)) flow_.mark(part, axis, first);
    }
  }

  /// For every axis and cut position, counts the nodes before the cut with a neighbour behind it, and the reverse.
  void sweep(const Part& part) {
    const NodeGraph& g = *lists_.graph;
    for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
      const NodeId* sorted = lists_.sorted[axis].data() + part.begin;
      for (NodeId i = 0; i < static_cast<NodeId>(part.size()); ++i) lists_.place[sorted[i]].rank[axis] = i;
      before_[axis].assign(part.size() + 1, 0);
      behind_[axis].assign(part.size() + 1, 0);
    }
    for (Index i = part.begin; i < part.end; ++i) {
      const NodeId v = lists_.sorted[0][i];
      const Ranks& at = lists_.place[v].rank;
      Ranks low = at, high = at;
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodePlace& other = lists_.place[g.neighbour[p]];
        if (other.label != part.label) continue;
        for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
          low[axis] = std::min(low[axis], other.rank[axis]);
          high[axis] = std::max(high[axis], other.rank[axis]);
        }
      }
      reach_[v] = high;
      for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
        ++before_[axis][at[axis] + 1], --before_[axis][high[axis] + 1];
        ++behind_[axis][low[axis] + 1], --behind_[axis][at[axis] + 1];
      }
    }
  }

  /// The best position along every axis, scored by the thinner of the two layers.
  std::array<Cut, dissection_axes> promising(const Part& part) const noexcept {
    const Index n = part.size();
    std::array<Cut, dissection_axes> cuts;
    for (std::size_t axis = 0; axis < dissection_axes; ++axis) {
      Index before = 0, behind = 0;
      for (Index t = 1; t < n; ++t) {
        before += before_[axis][t];
        behind += behind_[axis][t];
        const double bias = static_cast<double>(t) / static_cast<double>(n) - 0.5;
        if (bias <= -largest_bias || bias >= largest_bias) continue;
        const double score = separator_cost(static_cast<double>(std::min(before, behind)), bias);
        if (score < cuts[axis].score) cuts[axis] = {static_cast<int>(axis), t, score};
      }
    }
    return cuts;
  }

  /// Smallest set of nodes that covers every edge across a cut; returns the remaining size of either side and the size
  /// of the set.
  std::array<Index, 3> cover(const Part& part, const Cut& c) {
    describe_edges(part, c);
    cover_.solve(right_.size());
    std::array<Index, 3> sizes{c.position, part.size() - c.position, 0};
    for (Index i = 0; i < left_.size(); ++i)
      if (cover_.left_in_cover(i)) --sizes[0], ++sizes[2];
    for (Index i = 0; i < right_.size(); ++i)
      if (cover_.right_in_cover(i)) --sizes[1], ++sizes[2];
    return sizes;
  }

  /// Marks the side of every node, according to the last cover.
  void mark(const Part& part, const Cut& c) {
    const NodeVector& sorted = lists_.sorted[static_cast<std::size_t>(c.axis)];
    for (Index i = part.begin; i < part.end; ++i)
      lists_.side[sorted[i]] = i - part.begin < c.position ? side_first : side_second;
    for (Index i = 0; i < left_.size(); ++i)
      if (cover_.left_in_cover(i)) lists_.side[left_[i]] = side_separator;
    for (Index i = 0; i < right_.size(); ++i)
      if (cover_.right_in_cover(i)) lists_.side[right_[i]] = side_separator;
  }

  /// Passes the edges across the cut to the matching.
  void describe_edges(const Part& part, const Cut& c) {
    const NodeGraph& g = *lists_.graph;
    const auto axis = static_cast<std::size_t>(c.axis);
    for (NodeId v : right_) number_[v] = -1;
    cover_.clear();
    left_.clear();
    right_.clear();
    for (Index i = part.begin; i < part.begin + c.position; ++i) {
      const NodeId v = lists_.sorted[axis][i];
      if (reach_[v][axis] < c.position) continue;
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodeId u = g.neighbour[p];
        if (lists_.place[u].label != part.label || lists_.place[u].rank[axis] < c.position) continue;
        if (number_[u] < 0) {
          number_[u] = static_cast<NodeId>(right_.size());
          right_.push_back(u);
        }
        cover_.add_edge(number_[u]);
      }
      cover_.end_left();
      left_.push_back(v);
    }
  }

  PartLists& lists_;
  SeparatorRefinement refinement_;
  FlowSeparator flow_;
  IndexedVector<Ranks> reach_;  // per node, the greatest rank among itself and its neighbours
  std::array<NodeVector, dissection_axes> before_, behind_;
  BipartiteCover cover_;
  NodeVector left_, right_, number_;
  std::array<Index, 3> sizes_{};    // of the best separator so far
  double lowest_ = infinity;        // its score
  double lowest_cover_ = infinity;  // the best score before widening
};

}}}  // namespace palpate::detail
