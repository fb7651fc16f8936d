// Minimum vertex cover of a bipartite graph (Hopcroft and Karp 1973, Koenig 1931).
#pragma once

#include <palpate/linear/detail/indexed_vector.hpp>

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

}}}  // namespace palpate::detail
