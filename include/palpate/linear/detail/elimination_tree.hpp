// The elimination tree of a graph and the row count of each column of its factor.
#pragma once

#include <palpate/linear/detail/node_graph.hpp>

#include <algorithm>
#include <numeric>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Nodes in a postorder of the elimination tree, so that every subtree is contiguous.
struct EliminationTree {
  NodeVector order;     ///< node at every position
  NodeVector position;  ///< inverse of `order`
  NodeVector parent;    ///< per position, a later position or -1
  OffsetVector rows;    ///< per position the dofs in its column of the factor, including its own
};

/// Parents in the given order, by path compression (Liu 1990). Nearly O(edges).
inline NodeVector elimination_parents(const NodeGraph& g, const NodeVector& order, const NodeVector& position) {
  NodeVector parent(order.size(), -1), ancestor(order.size(), -1);
  for (NodeId i = 0; i < static_cast<NodeId>(order.size()); ++i)
    for (Index p = g.start[order[i]]; p < g.start[order[i] + 1]; ++p)
      for (NodeId k = position[g.neighbour[p]]; k >= 0 && k < i;) {
        const NodeId next = ancestor[k];
        ancestor[k] = i;
        if (next < 0) parent[k] = i;
        k = next;
      }
  return parent;
}

/// Postorder: children before parents, siblings in their given order. The result holds the new place of each node.
inline NodeVector postorder_places(const NodeVector& parent) {
  const auto n = static_cast<NodeId>(parent.size());
  NodeVector size(n, 1), place(n, -1);
  for (NodeId i = 0; i < n; ++i)
    if (parent[i] >= 0) size[parent[i]] += size[i];
  NodeVector next(n, 0);  // place of the first node of the next child's subtree
  NodeId roots = 0;
  for (NodeId i = n - 1; i >= 0; --i) {  // parents first; children from the last to the first
    NodeId& end = parent[i] < 0 ? roots : next[parent[i]];
    const NodeId limit = parent[i] < 0 ? n : static_cast<NodeId>(place[parent[i]]);
    place[i] = limit - end - 1;
    end += size[i];
  }
  return place;
}

/// Row counts of all columns without forming the factor (Gilbert, Ng and Peyton 1994), weighted with the dofs of the
/// rows. Nearly O(edges).
class RowCounts {
 public:
  RowCounts(const NodeGraph& g, const EliminationTree& t)
      : n_(static_cast<NodeId>(t.order.size())), first_(n_, -1), greatest_(n_, -1), previous_(n_, -1), ancestor_(n_) {
    std::iota(ancestor_.begin(), ancestor_.end(), NodeId{0});
    count_.assign(n_, 0);
    for (NodeId k = 0; k < n_; ++k) {
      if (first_[k] < 0) count_[k] = g.weight(t.order[k]);
      for (NodeId j = k; j >= 0 && first_[j] < 0; j = t.parent[j]) first_[j] = k;
    }
    for (NodeId j = 0; j < n_; ++j) visit(g, t, j);
    for (NodeId j = 0; j < n_; ++j)
      if (t.parent[j] >= 0) count_[t.parent[j]] += count_[j];
  }
  OffsetVector take() { return std::move(count_); }

 private:
  void visit(const NodeGraph& g, const EliminationTree& t, NodeId j) {
    if (t.parent[j] >= 0) count_[t.parent[j]] -= g.weight(t.order[j]);
    for (Index p = g.start[t.order[j]]; p < g.start[t.order[j] + 1]; ++p) {
      const NodeId i = t.position[g.neighbour[p]];
      if (i <= j || first_[j] <= greatest_[i]) continue;  // not a leaf of the row subtree of i
      greatest_[i] = first_[j];
      const NodeId before = previous_[i];
      previous_[i] = j;
      count_[j] += g.weight(t.order[i]);
      if (before >= 0) count_[common_ancestor(before)] -= g.weight(t.order[i]);
    }
    if (t.parent[j] >= 0) ancestor_[j] = t.parent[j];
  }
  NodeId common_ancestor(NodeId leaf) noexcept {
    NodeId root = leaf;
    while (root != ancestor_[root]) root = ancestor_[root];
    while (leaf != root) {
      const NodeId next = ancestor_[leaf];
      ancestor_[leaf] = root;
      leaf = next;
    }
    return root;
  }

  NodeId n_;
  NodeVector first_, greatest_, previous_, ancestor_;
  OffsetVector count_;
};

/// The elimination tree for an order. Kept nodes, which are at the end of the order, stay there.
inline EliminationTree elimination_tree(const NodeGraph& g, const NodeVector& order) {
  EliminationTree t;
  const Index n = order.size();
  t.position.resize(n);
  for (NodeId i = 0; i < static_cast<NodeId>(n); ++i) t.position[order[i]] = i;
  NodeVector parent = elimination_parents(g, order, t.position);
  const Index inner = n - std::count(g.kept.begin(), g.kept.end(), char{1});
  for (Index i = inner; i < n; ++i) parent[i] = i + 1 < n ? static_cast<NodeId>(i + 1) : -1;  // a chain: a dense front
  const NodeVector cut = [&] {  // kept nodes become roots, so that a postorder leaves them at the end
    NodeVector p = parent;
    for (Index i = 0; i < n; ++i)
      if (p[i] >= inner) p[i] = -1;
    return p;
  }();
  NodeVector place = postorder_places(cut);
  t.order.resize(n);
  t.parent.resize(n);
  for (Index i = 0; i < n; ++i) {
    t.order[place[i]] = order[i];
    t.parent[place[i]] = parent[i] < 0 ? -1 : place[parent[i]];
  }
  for (NodeId i = 0; i < static_cast<NodeId>(n); ++i) t.position[t.order[i]] = i;
  t.rows = RowCounts(g, t).take();
  return t;
}

}}}  // namespace palpate::detail
