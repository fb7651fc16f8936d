// Groups of columns of the factor with (almost) the same rows, each eliminated in one dense front.
#pragma once

#include <palpate/linear/detail/elimination_tree.hpp>
#include <palpate/linear/detail/lower_panels.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Supernodes in elimination order, children before parents.
struct Supernodes {
  NodeVector order;           ///< node at every position, supernode after supernode
  OffsetVector start;         ///< supernodes + 1 offsets into order
  NodeVector parent;          ///< supernode or -1
  OffsetVector pivots, rows;  ///< dofs eliminated, and coupled rows below them
};

/// Modelled time of a front in floating-point operations: a fixed cost, the cost of moving its entries, and the
/// factorisation. Merging small fronts adds operations on zeros and saves part of the first two.
inline double front_cost(double pivots, double rows) noexcept {
  constexpr double per_front = 60000.0, per_entry = 16.0;
  const double m = pivots + rows;
  return per_front + per_entry * (pivots * m + 0.5 * rows * rows) + pivots * (m * (m - pivots) + pivots * pivots / 3.0);
}

class SupernodeBuilder {
 public:
  SupernodeBuilder(const NodeGraph& g, const EliminationTree& t) : g_(g), t_(t) {
    find();
    for (NodeId s = 0; s < static_cast<NodeId>(parent_.size()); ++s) merge_children(s);
  }

  Supernodes build() {
    choose_child_order();
    Supernodes out;
    out.start.push_back(0);
    // Parents before children, last child first, then reversed: a postorder without recursion.
    NodeVector stack, reversed;
    for (NodeId s = 0; s < static_cast<NodeId>(parent_.size()); ++s)
      if (parent_[s] == -1) stack.push_back(s);
    while (!stack.empty()) {
      const NodeId s = stack.back();
      stack.pop_back();
      reversed.push_back(s);
      for (NodeId c = first_child_[s]; c >= 0; c = next_sibling_[c]) stack.push_back(c);
    }
    NodeVector number(parent_.size(), -1);
    for (Index i = reversed.size() - 1; i >= 0; --i) {
      number[reversed[i]] = static_cast<NodeId>(out.pivots.size());
      append(reversed[i], out);
    }
    out.parent.resize(out.pivots.size());
    for (NodeId s : reversed) out.parent[number[s]] = parent_[s] < 0 ? -1 : number[parent_[s]];
    return out;
  }

 private:
  static constexpr NodeId absorbed = -2;

  /// Finds chains of columns where each has the rows of the one before except its own; the kept nodes form one
  /// supernode.
  void find() {
    const Index n = t_.order.size();
    NodeVector super(n, -1);
    for (NodeId j = 0; j < static_cast<NodeId>(n); ++j) {
      const bool kept = g_.kept[t_.order[j]] != 0;
      const bool follows =
          j > 0 && t_.parent[j - 1] == j &&
          (kept ? g_.kept[t_.order[j - 1]] != 0 : t_.rows[j - 1] - g_.weight(t_.order[j - 1]) == t_.rows[j]);
      if (!follows) {
        begin_.push_back(j);
        pivots_.push_back(0);
        rows_.push_back(0);
      }
      super[j] = static_cast<NodeId>(begin_.size() - 1);
      pivots_.back() += g_.weight(t_.order[j]);
      rows_.back() = kept ? 0 : t_.rows[j] - g_.weight(t_.order[j]);
    }
    begin_.push_back(static_cast<NodeId>(n));
    link(super);
  }

  /// Builds the tree of the supernodes.
  void link(const NodeVector& super) {
    const Index count = pivots_.size();
    for (NodeVector* v : {&first_child_, &next_sibling_, &parent_, &next_}) v->assign(count, -1);
    zeros_.assign(count, 0.0);
    head_.resize(count);
    tail_.resize(count);
    for (NodeId s = static_cast<NodeId>(count) - 1; s >= 0; --s) {
      head_[s] = tail_[s] = s;
      const NodeId up = t_.parent[begin_[s + 1] - 1];
      if (up >= 0) adopt(super[up], s);
    }
  }

  void adopt(NodeId parent, NodeId child) noexcept {
    parent_[child] = parent;
    next_sibling_[child] = first_child_[parent];
    first_child_[parent] = child;
  }

  /// Allows only few zeros in large fronts, so that solves stay as fast as the factorisation.
  bool worth_merging(NodeId child, NodeId parent) const noexcept {
    const auto kc = static_cast<double>(pivots_[child]), rc = static_cast<double>(rows_[child]);
    const auto kp = static_cast<double>(pivots_[parent]), rp = static_cast<double>(rows_[parent]);
    if (front_cost(kc + kp, rp) > front_cost(kc, rc) + front_cost(kp, rp)) return false;
    const double zeros = zeros_[child] + zeros_[parent] + kc * (kp + rp - rc);
    const double entries = (kc + kp) * (0.5 * (kc + kp) + rp);
    return kc + kp <= 24.0 || zeros <= 0.2 * entries;
  }

  void merge_children(NodeId s) {
    if (g_.kept[t_.order[begin_[s]]] != 0) return;
    NodeId children = first_child_[s];
    first_child_[s] = -1;
    while (children >= 0) {
      const NodeId c = children;
      children = next_sibling_[c];
      if (worth_merging(c, s))
        absorb(c, s);
      else
        adopt(s, c);
    }
  }

  void absorb(NodeId c, NodeId s) {
    zeros_[s] += zeros_[c] + static_cast<double>(pivots_[c]) * static_cast<double>(pivots_[s] + rows_[s] - rows_[c]);
    pivots_[s] += pivots_[c];
    parent_[c] = absorbed;
    next_[tail_[c]] = head_[s];
    head_[s] = head_[c];
    for (NodeId g = first_child_[c]; g >= 0;) {
      const NodeId following = next_sibling_[g];
      adopt(s, g);
      g = following;
    }
  }

  /// Orders children by peak memory minus the memory that remains after them, largest first (Liu 1986).
  void choose_child_order() {
    OffsetVector peak(parent_.size(), 0), left(parent_.size(), 0);
    NodeVector children;
    for (NodeId s = 0; s < static_cast<NodeId>(parent_.size()); ++s) {
      if (parent_[s] == absorbed) continue;
      children.clear();
      for (NodeId c = first_child_[s]; c >= 0; c = next_sibling_[c]) children.push_back(c);
      std::stable_sort(children.begin(), children.end(),
                       [&](NodeId a, NodeId b) { return peak[a] - left[a] < peak[b] - left[b]; });
      first_child_[s] = -1;
      for (NodeId c : children) adopt(s, c);  // each goes before the previous ones
      left[s] = LowerPanels::of(rows_[s], rows_[s]).size();
      Index stored = 0;
      for (NodeId c = first_child_[s]; c >= 0; c = next_sibling_[c]) {
        peak[s] = std::max(peak[s], stored + peak[c]);
        stored += left[c];
      }
      peak[s] = std::max(peak[s], stored + left[s]);
    }
  }

  void append(NodeId s, Supernodes& out) const {
    for (NodeId part = head_[s]; part >= 0; part = part == s ? -1 : next_[part])
      for (Index j = begin_[part]; j < begin_[part + 1]; ++j) out.order.push_back(t_.order[j]);
    out.start.push_back(out.order.size());
    out.pivots.push_back(pivots_[s]);
    out.rows.push_back(rows_[s]);
  }

  const NodeGraph& g_;
  const EliminationTree& t_;
  NodeVector begin_, parent_, first_child_, next_sibling_;
  NodeVector head_, next_, tail_;  // the supernodes merged into one, in order
  OffsetVector pivots_, rows_;
  IndexedVector<double> zeros_;
};

/// Finds supernodes and merges a child into its parent where a time model predicts that this is faster.
inline Supernodes find_supernodes(const NodeGraph& g, const EliminationTree& t) {
  return SupernodeBuilder(g, t).build();
}

}}}  // namespace palpate::detail
