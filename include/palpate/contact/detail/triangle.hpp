// Closest point on a triangle.
#pragma once

#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

using Triangle = std::array<int, 3>;

namespace detail {

/// Location of a closest point on a triangle: inside, on edge (i, i + 1) or at vertex i.
enum class TriangleFeature : std::uint8_t { face, edge01, edge12, edge20, vertex0, vertex1, vertex2 };

/// A point of a triangle by barycentric weights (they sum to 1 and are not negative).
struct TrianglePoint {
  std::array<double, 3> weights;
  TriangleFeature feature;
};

/// The point of the segment from a to b closest to p, as its weight of b.
double closest_on_segment(const Vector3& p, const Vector3& a, const Vector3& b) noexcept;

/// The point closest to p on the three edges of a triangle, for a triangle of zero area.
TrianglePoint closest_on_edges(const Vector3& p, const std::array<Vector3, 3>& corner) noexcept;

/// The point of triangle (a, b, c) closest to p (Ericson, Real-Time Collision Detection, 5.1.5). For triangles of zero
/// area it is a point of one of their edges. About 40 flops, no allocation.
TrianglePoint closest_point(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) noexcept;

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/triangle.ipp>
#endif
