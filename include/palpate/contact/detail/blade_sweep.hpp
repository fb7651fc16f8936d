// The surface swept by the edge of a blade.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// The surface swept by the edge of a blade between two positions: the quadrilateral from edge (a0, b0) to edge (a1,
/// b1) [m], as two triangles. The frame is that of the points passed to its functions.
struct BladeSweep {
  Vector3 a0 = Vector3::Zero(), b0 = Vector3::Zero(), a1 = Vector3::Zero(), b1 = Vector3::Zero();

  /// [m^2]
  double area() const noexcept { return 0.5 * (cross(b0 - a0, b1 - a0).norm() + cross(b1 - a0, a1 - a0).norm()); }
  detail::Box box() const noexcept {
    detail::Box box;
    for (const Vector3& x : {a0, b0, a1, b1}) box.include(x);
    return box;
  }
  /// Whether the segment from p to q crosses it. A point on the surface, up to a distance of 1e-9 of that from a
  /// corner, counts as on its front side, and a segment through its boundary as a crossing: points on the two sides of
  /// a closed surface are never left connected.
  bool crosses(const Vector3& p, const Vector3& q) const noexcept {
    return crosses_triangle(p, q, a0, b0, b1) || crosses_triangle(p, q, a0, b1, a1);
  }

 private:
  static double volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept {
    return cross(b - a, c - a).dot(d - a);
  }
  /// The side of the line from p to q on which the edge from x to y passes; exactly the opposite for the edge from y to
  /// x, so that no segment passes between two triangles with a common edge.
  static double side(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y) noexcept {
    return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3) ? volume(p, q, x, y)
                                                                                        : -volume(p, q, y, x);
  }
  static bool crosses_triangle(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y,
                               const Vector3& z) noexcept;
};

inline bool BladeSweep::crosses_triangle(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y,
                                         const Vector3& z) noexcept {
  // A point this near to the plane is on it: rounding, and so the pose of a body, does not decide on which side it is.
  constexpr double on_plane = 1e-9;  // of the distance from a corner
  const Vector3 normal = cross(y - x, z - x);
  const double margin = on_plane * normal.norm();
  const auto is_in_front = [&](const Vector3& at) { return normal.dot(at - x) >= -margin * (at - x).norm(); };
  if (is_in_front(p) == is_in_front(q)) return false;
  const double beside = on_plane * (q - p).norm() * (z - x).norm() * (y - x).norm();
  const double u = side(p, q, x, y), v = side(p, q, y, z), w = side(p, q, z, x);
  const double least = std::min({u, v, w}), most = std::max({u, v, w});
  return least >= -beside || most <= beside;
}

}}  // namespace palpate
