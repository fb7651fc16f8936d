// From supernodes to fronts.
#pragma once

#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/supernodes.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Builds the fronts of the supernodes and places the entries of a matrix in them.
FrontTree build_front_tree(const NodeGraph& g, const Supernodes& s, const SparseLower& lower);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/front_tree_builder.ipp>
#endif
