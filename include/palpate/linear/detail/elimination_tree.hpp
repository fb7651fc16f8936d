// The elimination tree of a graph, and how many rows each column of its factor has.
#pragma once

#include <palpate/linear/detail/node_graph.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Nodes in a postorder of the elimination tree, so that every subtree is contiguous.
struct EliminationTree {
  NodeVector order;     ///< node at every position
  NodeVector position;  ///< its inverse
  NodeVector parent;    ///< per position, a later position or -1
  OffsetVector rows;    ///< per position the dofs of its column of the factor, its own included
};

/// The tree of an elimination order. Kept nodes, at its end, stay where they are.
EliminationTree elimination_tree(const NodeGraph& g, const NodeVector& order);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/elimination_tree.ipp>
#endif
