// Definitions of blade_inside.hpp.
#pragma once

#include <palpate/contact/detail/blade_inside.hpp>
#include <palpate/contact/detail/triangle.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// Tissue ends where a line leaves it: behind the nearest wall, the line from the point to it passes through the other
/// one from the inside. A point beyond the end of a slit is nearest to the rim of its walls: the line from there runs
/// along them, and rounding would decide whether it leaves one.
PALPATE_INLINE bool is_in_tissue(const ContactSurface& surface, const Vector3& p, double reach) noexcept {
  if (surface.is_inside(p)) return true;
  const ContactSurface::Closest nearest = surface.closest(p);
  if (nearest.triangle < 0 || !(nearest.distance >= 0.0)) return false;  // by the shell it is outside
  const auto closest_on = [&](int t, const Vector3& x) {
    const Triangle& v = surface.triangle(t);
    return closest_point(x, surface.position(v[0]), surface.position(v[1]), surface.position(v[2]));
  };
  if (surface.is_rim(nearest.triangle, closest_on(nearest.triangle, p).feature)) return false;
  constexpr double least_slope = 0.3;
  const Vector3 to = nearest.point - p;
  const double distance = to.norm(), tiny = 1e-6 * reach;
  const Vector3 ahead = distance > tiny ? Vector3(to / distance) : Vector3(-nearest.outward);
  const double length = distance + reach;
  const Vector3 path = length * ahead;
  bool leaves = false;
  surface.bvh().visit_along(p, path, tiny, [&](int t) {
    const double along = surface.normal(t).dot(path);
    if (!(along > least_slope * length)) return 1.0;
    const Triangle& v = surface.triangle(t);
    const double part = surface.normal(t).dot(surface.position(v[0]) - p) / along;
    if (!(part * length >= -tiny && part <= 1.0)) return 1.0;
    const Vector3 x = p + part * path;
    const TrianglePoint on = closest_on(t, x);
    const Vector3 y = on.weights[0] * surface.position(v[0]) + on.weights[1] * surface.position(v[1]) +
                      on.weights[2] * surface.position(v[2]);
    leaves = leaves || (x - y).norm() <= tiny;
    return leaves ? 0.0 : 1.0;
  });
  return leaves;
}

}}  // namespace palpate
