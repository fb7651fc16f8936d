// Smallest separators of a part of a graph: minimum vertex cover of a bipartite graph (Hopcroft and Karp 1973, Koenig
// 1931), and maximum flow between two ends (Dinic 1970, Menger 1927).
#pragma once

#include <palpate/linear/detail/indexed_vector.hpp>
#include <palpate/linear/detail/part_lists.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Edges between `left` and `right` nodes, each numbered from 0; the smallest set of nodes that covers every edge.
class BipartiteCover {
 public:
  /// Clears the graph; keeps the capacity of its arrays.
  void clear() noexcept {
    start_.clear();
    start_.push_back(0);
    to_.clear();
  }
  /// Adds an edge of the current left node.
  void add_edge(NodeId right) { to_.push_back(right); }
  /// Ends the edges of the current left node.
  void end_left() { start_.push_back(to_.size()); }

  /// Finds the cover; O(edges sqrt(nodes)).
  void solve(Index right_count) {
    left_mate_.assign(start_.size() - 1, -1);
    right_mate_.assign(right_count, -1);
    match_greedily();
    while (grade()) augment_all();
    // Koenig's set: the nodes reached by the last search, from the unmatched left nodes along alternating paths.
    right_reached_.assign(right_count, 0);
    for (Index l = 0; l < lefts(); ++l)
      if (level_[l] >= 0)
        for (Index p = start_[l]; p < start_[l + 1]; ++p) right_reached_[to_[p]] = 1;
  }
  bool left_in_cover(Index l) const noexcept { return level_[l] < 0; }
  bool right_in_cover(Index r) const noexcept { return right_reached_[r] != 0; }

 private:
  Index lefts() const noexcept { return start_.size() - 1; }

  void match_greedily() noexcept {
    for (Index l = 0; l < lefts(); ++l)
      for (Index p = start_[l]; p < start_[l + 1]; ++p)
        if (right_mate_[to_[p]] < 0) {
          match(static_cast<NodeId>(l), to_[p]);
          break;
        }
  }
  void match(NodeId l, NodeId r) noexcept {
    left_mate_[l] = r;
    right_mate_[r] = l;
  }

  /// Breadth-first search from the unmatched left nodes; true when it reaches an unmatched right node.
  bool grade() {
    level_.assign(lefts(), -1);
    queue_.clear();
    for (Index l = 0; l < lefts(); ++l)
      if (left_mate_[l] < 0) {
        level_[l] = 0;
        queue_.push_back(static_cast<NodeId>(l));
      }
    bool found = false;
    for (Index head = 0; head < queue_.size(); ++head) {
      const NodeId l = queue_[head];
      for (Index p = start_[l]; p < start_[l + 1]; ++p) {
        const NodeId next = right_mate_[to_[p]];
        if (next < 0)
          found = true;
        else if (level_[next] < 0) {
          level_[next] = level_[l] + 1;
          queue_.push_back(next);
        }
      }
    }
    return found;
  }

  void augment_all() {
    next_edge_ = start_;
    for (Index l = 0; l < lefts(); ++l)
      if (left_mate_[l] < 0) augment(static_cast<NodeId>(l));
  }

  /// Depth-first search along increasing levels. Uses an explicit stack because paths can be long.
  void augment(NodeId root) {
    path_.clear();
    path_.push_back(root);
    while (!path_.empty()) {
      const NodeId l = path_.back();
      if (next_edge_[l] == start_[l + 1]) {
        level_[l] = -1;  // a dead end
        path_.pop_back();
        if (!path_.empty()) ++next_edge_[path_.back()];
        continue;
      }
      const NodeId next = right_mate_[to_[next_edge_[l]]];
      if (next < 0) {
        for (Index i = path_.size() - 1; i >= 0; --i) match(path_[i], to_[next_edge_[path_[i]]]);
        return;
      }
      if (level_[next] == level_[l] + 1)
        path_.push_back(next);
      else
        ++next_edge_[l];
    }
  }

  OffsetVector start_, next_edge_;
  NodeVector to_, left_mate_, right_mate_, queue_, path_;
  NodeVector level_;
  IndexedVector<char> right_reached_;
};

/// Lists a part in some order and separates its first nodes from its last ones by a minimum vertex cut. The flow is a
/// set of paths without common nodes; a search enters a node (state 2 i) and leaves it (2 i + 1). O(edges sqrt(nodes))
/// at worst.
class FlowSeparator {
 public:
  explicit FlowSeparator(PartLists& lists) : lists_(lists) {}

  /// Of all nodes of the part in the order of an axis, those before `first` are on the first side and those from `last`
  /// on are on the second. Returns the sizes of the better one of the two extreme minimum cuts; everything on the first
  /// side when an edge joins the ends, so that nothing between separates them. O(edges) per search.
  std::array<Index, 3> cut(const Part& part, std::size_t axis, Index first, Index last) {
    if (!describe(part, axis, first, last)) return {part.size(), 0, 0};
    while (search()) augment_all();
    reached_ = level_;
    const std::array<Index, 3> early = sizes(part, first, last, [&](Index i) { return side_from_source(i); });
    search_back();
    const std::array<Index, 3> late = sizes(part, first, last, [&](Index i) { return side_from_sink(i); });
    early_ = separator_score(early, part.size()) <= separator_score(late, part.size());
    return early_ ? early : late;
  }

  /// Marks the sides of the last cut.
  void mark(const Part& part, std::size_t axis, Index first) {
    const NodeId* sorted = lists_.sorted[axis].data() + part.begin;
    for (Index i = 0; i < part.size(); ++i) lists_.side[sorted[i]] = i < first ? side_first : side_second;
    for (Index i = 0; i < count(); ++i)
      lists_.side[sorted[first + i]] = early_ ? side_from_source(i) : side_from_sink(i);
  }

 private:
  static constexpr NodeId none = -1, end = -2;

  Index count() const noexcept { return start_.size() - 1; }
  Side side_from_source(Index i) const noexcept {
    if (reached_[2 * i + 1] >= 0) return side_first;
    return reached_[2 * i] >= 0 ? side_separator : side_second;
  }
  Side side_from_sink(Index i) const noexcept {
    if (level_[2 * i] >= 0) return side_second;
    return level_[2 * i + 1] >= 0 ? side_separator : side_first;
  }
  template <class SideOf>
  std::array<Index, 3> sizes(const Part& part, Index first, Index last, SideOf&& side) const noexcept {
    std::array<Index, 3> s{first, part.size() - last, 0};
    for (Index i = 0; i < count(); ++i) ++s[side(i)];
    return s;
  }

  /// Numbers the nodes between the ends and lists their edges. False when an edge joins the ends.
  bool describe(const Part& part, std::size_t axis, Index first, Index last) {
    const NodeGraph& g = *lists_.graph;
    start_.assign(1, 0);
    neighbour_.clear();
    at_source_.assign(last - first, 0);
    at_sink_.assign(last - first, 0);
    for (Index i = first; i < last; ++i) {
      const NodeId v = lists_.sorted[axis][part.begin + i];
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodePlace& other = lists_.place[g.neighbour[p]];
        if (other.label != part.label) continue;
        const Index rank = other.rank[axis];
        if (rank < first)
          at_source_[i - first] = 1;
        else if (rank >= last)
          at_sink_[i - first] = 1;
        else
          neighbour_.push_back(static_cast<NodeId>(rank - first));
      }
      start_.push_back(neighbour_.size());
    }
    before_.assign(count(), none);
    after_.assign(count(), none);
    return !joined(part, axis, first, last);
  }
  bool joined(const Part& part, std::size_t axis, Index first, Index last) const noexcept {
    const NodeGraph& g = *lists_.graph;
    for (Index i = 0; i < first; ++i) {
      const NodeId v = lists_.sorted[axis][part.begin + i];
      for (Index p = g.start[v]; p < g.start[v + 1]; ++p) {
        const NodePlace& other = lists_.place[g.neighbour[p]];
        if (other.label == part.label && other.rank[axis] >= last) return true;
      }
    }
    return false;
  }

  void visit(Index state, NodeId level) {
    if (level_[state] >= 0) return;
    level_[state] = level;
    queue_.push_back(static_cast<NodeId>(state));
  }
  bool used(Index i) const noexcept { return before_[i] != none; }

  /// Breadth-first search from the first side; true when it reaches the second side.
  bool search() {
    level_.assign(2 * count(), -1);
    queue_.clear();
    for (Index i = 0; i < count(); ++i)
      if (at_source_[i] != 0) visit(2 * i, 0);
    bool found = false;
    for (Index head = 0; head < queue_.size(); ++head) {
      const NodeId state = queue_[head], i = state / 2, next = level_[state] + 1;
      if (state % 2 == 0) {
        if (!used(i))
          visit(2 * i + 1, next);
        else if (before_[i] >= 0)
          visit(2 * before_[i] + 1, next);
        continue;
      }
      found = found || at_sink_[i] != 0;
      if (used(i)) visit(2 * i, next);
      if (!found)
        for (Index p = start_[i]; p < start_[i + 1]; ++p) visit(2 * neighbour_[p], next);
    }
    return found;
  }

  /// The states from which the second side can be reached.
  void search_back() {
    level_.assign(2 * count(), -1);
    queue_.clear();
    for (Index i = 0; i < count(); ++i)
      if (at_sink_[i] != 0) visit(2 * i + 1, 0);
    for (Index head = 0; head < queue_.size(); ++head) {
      const NodeId state = queue_[head], i = state / 2, next = level_[state] + 1;
      if (state % 2 == 1) {
        if (!used(i))
          visit(2 * i, next);
        else if (after_[i] >= 0)
          visit(2 * after_[i], next);
        continue;
      }
      if (used(i)) visit(2 * i + 1, next);
      for (Index p = start_[i]; p < start_[i + 1]; ++p) visit(2 * neighbour_[p] + 1, next);
    }
  }

  void augment_all() {
    next_edge_ = start_;
    for (Index i = 0; i < count(); ++i)
      if (at_source_[i] != 0) augment(2 * i);
  }

  /// Depth-first search along increasing levels, with an explicit stack because paths can be long.
  void augment(Index root) {
    if (level_[root] != 0) return;
    path_.assign(1, static_cast<NodeId>(root));
    while (!path_.empty()) {
      const NodeId state = path_.back(), i = state / 2;
      if (state % 2 == 1 && at_sink_[i] != 0) return apply();
      const NodeId next = state % 2 == 0 ? step_in(i) : step_out(i);
      if (next >= 0) {
        path_.push_back(next);
      } else {
        level_[state] = -1;  // a dead end
        path_.pop_back();
      }
    }
  }
  NodeId admissible(NodeId from, Index to) const noexcept {
    return level_[to] == level_[from] + 1 ? static_cast<NodeId>(to) : none;
  }
  NodeId step_in(NodeId i) const noexcept {
    if (!used(i)) return admissible(2 * i, 2 * Index{i} + 1);
    return before_[i] >= 0 ? admissible(2 * i, 2 * Index{before_[i]} + 1) : none;
  }
  NodeId step_out(NodeId i) noexcept {
    for (Index& p = next_edge_[i]; p < start_[i + 1]; ++p)
      if (const NodeId to = admissible(2 * i + 1, 2 * Index{neighbour_[p]}); to >= 0) return to;
    return used(i) ? admissible(2 * i + 1, 2 * Index{i}) : none;
  }

  /// Adds the path to the flow. Its states are not visited again in this phase.
  void apply() noexcept {
    before_[path_[0] / 2] = end;
    for (Index s = 1; s < path_.size(); ++s) {
      const NodeId from = path_[s - 1], to = path_[s], a = from / 2, b = to / 2;
      if (a == b && from % 2 == 1) {
        before_[a] = after_[a] = none;  // no path leads through it any more
      } else if (a != b && from % 2 == 1) {
        after_[a] = b;
        before_[b] = a;
      }
    }
    after_[path_.back() / 2] = end;
    for (NodeId state : path_) level_[state] = -1;
  }

  PartLists& lists_;
  OffsetVector start_, next_edge_;
  NodeVector neighbour_;
  IndexedVector<char> at_source_, at_sink_;
  NodeVector before_, after_;  // per node its neighbours on its path; `end` outside, `none` without a path
  NodeVector level_, reached_, queue_, path_;
  bool early_ = true;
};

}}}  // namespace palpate::detail
