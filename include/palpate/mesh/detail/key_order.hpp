// Sorts sets of nodes, so that equal sets are adjacent.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The order of keys of `width` numbers each, compared lexicographically; equal keys are ordered by their place in
/// `keys`. The first number of each must be 0 ... node_count - 1. O(keys) for sets of nodes of a mesh; allocates.
std::vector<Index> key_order(const std::vector<NodeId>& keys, int width, Index node_count);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/key_order.ipp>
#endif
