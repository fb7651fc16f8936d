// Definitions of node_graph.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/linear/detail/node_graph.hpp>

#include <algorithm>
#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Assigns consecutive dofs with the same neighbours, including each other, to the same node. This recovers the dofs
/// of a mesh node when no layout is given. O(nonzeros).
inline std::vector<Index> nodes_from_equal_rows(const SparseLower& lower) {
  const Index n = lower.rows();
  const Index* start = lower.outerIndexPtr();
  const Index* row = lower.innerIndexPtr();
  const auto mix = [](Index i) {
    std::uint64_t z = (static_cast<std::uint64_t>(i) + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    return z ^ (z >> 27);
  };
  IndexedVector<std::uint64_t> hash(n, 0);  // of the whole row; a sum, so independent of the order
  for (Index j = 0; j < n; ++j) {
    hash[j] += mix(j);
    for (Index p = start[j]; p < start[j + 1]; ++p)
      if (row[p] > j) {
        hash[j] += mix(row[p]);
        hash[row[p]] += mix(j);
      }
  }
  std::vector<Index> node(static_cast<std::size_t>(n));
  Index count = -1;
  for (Index j = 0; j < n; ++j) {
    if (j == 0 || hash[j] != hash[j - 1]) ++count;
    node[static_cast<std::size_t>(j)] = count;
  }
  return node;
}

/// Numbers the nodes in the order of their first dof; the kept dofs of a node form a node of their own.
inline void collect_nodes(NodeGraph& g, const DofLayout& layout, const std::vector<Index>& node_of_dof) {
  const Index n = static_cast<Index>(node_of_dof.size());
  IndexedVector<char> kept(n, 0);
  for (Index dof : layout.kept) kept[dof] = 1;
  const Index ids = n == 0 ? 0 : *std::max_element(node_of_dof.begin(), node_of_dof.end()) + 1;
  NodeVector number(2 * ids, -1);
  g.node_of_dof.resize(n);
  g.dof_start.push_back(0);
  for (Index dof = 0; dof < n; ++dof) {
    const Index id = node_of_dof[static_cast<std::size_t>(dof)];
    NodeId& node = number[2 * id + kept[dof]];
    if (node < 0) {
      node = static_cast<NodeId>(g.kept.size());
      g.kept.push_back(kept[dof]);
      g.dof_start.push_back(0);
      if (!layout.positions.empty()) g.positions.push_back(layout.positions[static_cast<std::size_t>(id)]);
    }
    g.node_of_dof[dof] = node;
    ++g.dof_start[node + 1];
  }
  accumulate_offsets(g.dof_start);
  g.dof.resize(n);
  OffsetVector fill = g.dof_start;
  for (Index dof = 0; dof < n; ++dof) g.dof[fill[g.node_of_dof[dof]]++] = dof;
}

/// Visits every pair of coupled nodes once.
template <class Visit>
void visit_edges(const NodeGraph& g, const SparseLower& lower, Visit&& visit) {
  const Index* start = lower.outerIndexPtr();
  const Index* row = lower.innerIndexPtr();
  const Index count = g.kept.size();
  NodeVector seen(count, -1);
  for (Index node = 0; node < count; ++node) {
    seen[node] = static_cast<NodeId>(node);
    for (Index d = g.dof_start[node]; d < g.dof_start[node + 1]; ++d)
      for (Index p = start[g.dof[d]]; p < start[g.dof[d] + 1]; ++p) {
        const NodeId other = g.node_of_dof[row[p]];
        if (seen[other] == node || row[p] < g.dof[d]) continue;
        seen[other] = static_cast<NodeId>(node);
        visit(static_cast<NodeId>(node), other);
      }
  }
}

inline void check_layout(const SparseLower& lower, const DofLayout& layout) {
  const std::size_t n = static_cast<std::size_t>(lower.rows());
  bool fine = lower.rows() == lower.cols() && lower.rows() < std::numeric_limits<NodeId>::max() / 4;
  fine = fine && (layout.node_of_dof.empty() || layout.node_of_dof.size() == n);
  for (Index node : layout.node_of_dof)
    fine = fine && node >= 0 && node < std::numeric_limits<NodeId>::max() / 4 &&
           (layout.positions.empty() || static_cast<std::size_t>(node) < layout.positions.size());
  fine = fine && (layout.positions.empty() || layout.node_of_dof.size() == n);
  std::vector<Index> kept = layout.kept;
  std::sort(kept.begin(), kept.end());
  fine = fine && std::adjacent_find(kept.begin(), kept.end()) == kept.end();
  fine = fine && (kept.empty() || (kept.front() >= 0 && kept.back() < lower.rows()));
  for (const Vector3& x : layout.positions) fine = fine && all_finite(x);
  if (!fine)
    raise(SetupErrorKind::bad_argument, "the dof layout does not fit the matrix",
          "Give a square matrix, one node per dof, finite coordinates for every node, and each kept dof once");
}

PALPATE_INLINE NodeGraph node_graph(const SparseLower& lower, const DofLayout& layout) {
  check_layout(lower, layout);
  NodeGraph g;
  collect_nodes(g, layout, layout.node_of_dof.empty() ? nodes_from_equal_rows(lower) : layout.node_of_dof);
  const Index count = g.kept.size();
  std::vector<std::array<NodeId, 2>> edges;
  edges.reserve(static_cast<std::size_t>(8 * count));
  g.start.assign(count + 1, 0);
  visit_edges(g, lower, [&](NodeId a, NodeId b) {
    edges.push_back({a, b});
    ++g.start[a + 1];
    ++g.start[b + 1];
  });
  // A pair found from both sides (interleaved dofs of two nodes) is stored twice, which is harmless.
  accumulate_offsets(g.start);
  g.neighbour.resize(g.start[count]);
  OffsetVector fill = g.start;
  for (const auto& [a, b] : edges) {
    g.neighbour[fill[a]++] = b;
    g.neighbour[fill[b]++] = a;
  }
  return g;
}

}}}  // namespace palpate::detail
