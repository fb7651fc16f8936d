// Distance between a convex hull and a triangle.
#pragma once

#include <palpate/contact/convex_hull.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A direction that separates a convex hull from a triangle, best the one of their closest points.
struct Separation {
  Vector3 normal = Vector3::Zero();  ///< unit, from the triangle to the hull; zero if they overlap
  double distance = 0.0;  ///< between them along the normal [m]: never more than their distance; 0 if they overlap
};

/// The separation of the hull of some points (1 to 64) from a triangle (Gilbert, Johnson and Keerthi 1988; the closest
/// point of a simplex from the closest points of its triangles). At most 32 rounds, each of the work of one support
/// query; a result of fewer rounds than needed is still a lower bound. No allocation.
Separation separate(std::span<const Vector3> points, const std::array<Vector3, 3>& corner) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/hull_separation.ipp>
#endif
