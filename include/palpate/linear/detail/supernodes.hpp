// Groups of columns of the factor with (almost) the same rows, each eliminated in one dense front.
#pragma once

#include <palpate/linear/detail/elimination_tree.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Supernodes in elimination order, children before parents.
struct Supernodes {
  NodeVector order;           ///< node at every position, supernode after supernode
  OffsetVector start;         ///< supernodes + 1 offsets into order
  NodeVector parent;          ///< supernode or -1
  OffsetVector pivots, rows;  ///< dofs eliminated, and coupled rows below them
};

/// Finds supernodes and merges a child into its parent where a time model predicts that this is faster.
Supernodes find_supernodes(const NodeGraph& g, const EliminationTree& t);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/supernodes.ipp>
#endif
