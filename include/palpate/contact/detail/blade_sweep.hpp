// The surface swept by the edge of a blade.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The surface swept by the edge of a blade between two positions: the quadrilateral from edge (a0, b0) to edge (a1,
/// b1) [m], as two triangles. The frame is that of the points passed to its functions.
struct BladeSweep {
  Vector3 a0 = Vector3::Zero(), b0 = Vector3::Zero(), a1 = Vector3::Zero(), b1 = Vector3::Zero();

  /// [m^2]
  double area() const noexcept;
  Box box() const noexcept;
  /// Whether the segment from p to q crosses it. A point on the surface, up to a distance of 1e-9 of that from a
  /// corner, counts as on its front side, and a segment through its boundary as a crossing: points on the two sides of
  /// a closed surface are never left connected.
  bool crosses(const Vector3& p, const Vector3& q) const noexcept;

 private:
  static double volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept;
  /// The side of the line from p to q on which the edge from x to y passes; exactly the opposite for the edge from y to
  /// x, so that no segment passes between two triangles with a common edge.
  static double side(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y) noexcept;
  static bool crosses_triangle(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y,
                               const Vector3& z) noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/blade_sweep.ipp>
#endif
