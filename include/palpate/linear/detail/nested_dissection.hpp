// Elimination order by nested dissection (George 1973; Lipton, Rose and Tarjan 1979).
#pragma once

#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/node_graph.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The nodes of a graph in elimination order, kept ones last. Uses coordinates if there are any. The order is the same
/// for any number of threads. O(edges log nodes). Throws cancelled.
detail::NodeVector nested_dissection(const NodeGraph& graph, const SetupLimits& limits = {});

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/nested_dissection.ipp>
#endif
