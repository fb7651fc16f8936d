// Definitions of sweep.hpp.
#pragma once

#include <palpate/contact/detail/sweep.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double sphere_meets_point(const Vector3& from, const Vector3& path, double radius,
                                         const Vector3& point) noexcept {
  const Vector3 offset = from - point;
  const double a = path.squaredNorm(), b = offset.dot(path), c = offset.squaredNorm() - radius * radius;
  if (!(b < 0.0)) return infinity;
  if (c <= 0.0) return 0.0;
  const double root = b * b - a * c;
  return root >= 0.0 ? c / (-b + std::sqrt(root)) : infinity;  // the smaller one, without cancellation
}

PALPATE_INLINE double sphere_meets_segment(const Vector3& from, const Vector3& path, double radius, const Vector3& p,
                                           const Vector3& q) noexcept {
  const Vector3 along = q - p;
  const double length2 = along.squaredNorm();
  if (!(length2 > 0.0)) return infinity;
  const auto across = [&](const Vector3& v) -> Vector3 { return v - (v.dot(along) / length2) * along; };
  const double t = sphere_meets_point(across(from - p), across(path), radius, Vector3::Zero());
  if (!(t <= 1.0)) return infinity;
  const double s = (from + t * path - p).dot(along);
  return s >= 0.0 && s <= length2 ? t : infinity;
}

PALPATE_INLINE double sphere_meets_triangle(const Vector3& from, const Vector3& path, double radius,
                                            const std::array<Vector3, 3>& corner, const Vector3& normal) noexcept {
  const double height = normal.dot(from - corner[0]), falls = -normal.dot(path);
  if (!(falls > 0.0) || !(height >= 0.0)) return infinity;
  const double t = std::max(0.0, (height - radius) / falls);
  if (!(t <= 1.0)) return infinity;  // edges and corners are in its plane, and are not reached earlier
  const Vector3 centre = from + t * path;
  const Vector3 foot = centre - normal.dot(centre - corner[0]) * normal;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i)
    inside = inside && normal.dot(cross(corner[(i + 1) % 3] - corner[i], foot - corner[i])) >= 0.0;
  if (inside) return t;
  double first = infinity;
  for (std::size_t i = 0; i < 3; ++i) {
    first = std::min(first, sphere_meets_point(from, path, radius, corner[i]));
    first = std::min(first, sphere_meets_segment(from, path, radius, corner[i], corner[(i + 1) % 3]));
  }
  return first;
}

PALPATE_INLINE double first_touch(const ContactSurface& surface, const Vector3& from, const Vector3& path,
                                  double radius) noexcept {
  double first = 1.0;
  surface.bvh().visit_along(from, path, radius, [&](int t) {
    const Triangle& v = surface.triangle(t);
    const double at = sphere_meets_triangle(from, path, radius,
                                            {surface.position(v[0]), surface.position(v[1]), surface.position(v[2])},
                                            surface.normal(t));
    first = std::min(first, at);
    return first;
  });
  return first;
}

}}  // namespace palpate
