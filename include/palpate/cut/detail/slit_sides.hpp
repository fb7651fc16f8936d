// The two sides of the slits in a surface.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// For every vertex of a surface 1 on one lip of a slit, -1 on the other one, and less away from them; 0 far away, and
/// where a vertex belongs to both. Vertices split from one node are on opposite lips, those of a triangle on the same.
/// `origin[v]` is the same for vertices that were one. O(triangles).
std::vector<double> slit_sides(const std::vector<Triangle>& triangles, const std::vector<NodeId>& origin);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/slit_sides.ipp>
#endif
