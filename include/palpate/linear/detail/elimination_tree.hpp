// The elimination tree of a graph and the row count of each column of its factor.
#pragma once

#include <palpate/linear/detail/node_graph.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Nodes in a postorder of the elimination tree, so that every subtree is contiguous.
struct EliminationTree {
  NodeVector order;     ///< node at every position
  NodeVector position;  ///< inverse of `order`
  NodeVector parent;    ///< per position, a later position or -1
  OffsetVector rows;    ///< per position the dofs in its column of the factor, including its own
};

/// The elimination tree for an order. Kept nodes, which are at the end of the order, stay there.
EliminationTree elimination_tree(const NodeGraph& g, const NodeVector& order);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/elimination_tree.ipp>
#endif
