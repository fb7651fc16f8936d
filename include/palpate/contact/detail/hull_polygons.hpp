// Construction of the convex hull of a few points.
#pragma once

#include <palpate/core/types.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Vertices and faces of a convex hull. Coplanar triangles are one polygon.
struct HullPolygons {
  int dimension = 0;  ///< 0: a point, 1: a segment, 2: a plane polygon, 3: a polyhedron
  std::vector<Vector3> vertices;
  /// Vertices of every face, anticlockwise seen from outside; of a plane polygon both sides.
  std::vector<std::vector<int>> faces;
};

/// Points closer than this part of the size of all points are one point, or on one plane.
inline constexpr double hull_tolerance = 1e-9;
/// Below this part of its length a hull has no width; below this part of its length and width it is plane.
inline constexpr double hull_flatness = 1e-6;

/// The convex hull of 1 to 64 points. Every plane through three points that has all others on one side is a face; for
/// so few points no faster construction is needed. Throws bad_argument for none or more than 64 points (value,
/// threshold), points that are not finite (ids: the points), and points whose hull is not closed because it has
/// features smaller than a millionth of it. Allocates; for set-up.
HullPolygons hull_polygons(std::span<const Vector3> points);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/hull_polygons.ipp>
#endif
