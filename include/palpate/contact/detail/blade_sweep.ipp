// Definitions of blade_sweep.hpp.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double BladeSweep::area() const noexcept {
  return 0.5 * (cross(b0 - a0, b1 - a0).norm() + cross(b1 - a0, a1 - a0).norm());
}

PALPATE_INLINE Box BladeSweep::box() const noexcept {
  Box box;
  for (const Vector3& x : {a0, b0, a1, b1}) box.include(x);
  return box;
}

PALPATE_INLINE bool BladeSweep::crosses(const Vector3& p, const Vector3& q) const noexcept {
  return crosses_triangle(p, q, a0, b0, b1) || crosses_triangle(p, q, a0, b1, a1);
}

PALPATE_INLINE double BladeSweep::volume(const Vector3& a, const Vector3& b, const Vector3& c,
                                         const Vector3& d) noexcept {
  return cross(b - a, c - a).dot(d - a);
}

PALPATE_INLINE double BladeSweep::side(const Vector3& p, const Vector3& q, const Vector3& x,
                                       const Vector3& y) noexcept {
  return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3) ? volume(p, q, x, y)
                                                                                      : -volume(p, q, y, x);
}

PALPATE_INLINE bool BladeSweep::crosses_triangle(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y,
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
