// Definitions of blade_inside.hpp.
#pragma once

#include <palpate/contact/detail/blade_inside.hpp>
#include <palpate/contact/detail/triangle.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// Tissue ends where a line leaves it: behind the nearest wall, the line from the point passes through the other one
/// from the inside.
PALPATE_INLINE bool is_in_tissue(const ContactSurface& surface, const Vector3& p, double reach) noexcept {
  if (surface.is_inside(p)) return true;
  const ContactSurface::Closest nearest = surface.closest(p);
  if (nearest.triangle < 0 || !(nearest.distance >= 0.0)) return false;  // by the shell it is outside
  const auto closest_on = [&](int t, const Vector3& x) {
    const Triangle& v = surface.triangle(t);
    return closest_point(x, surface.position(v[0]), surface.position(v[1]), surface.position(v[2]));
  };
  if (surface.is_rim(nearest.triangle, closest_on(nearest.triangle, p).feature)) return false;
  const Vector3 ahead = -nearest.outward, path = (std::min(nearest.distance, reach) + reach) * ahead;
  const Vector3 from = nearest.point - std::min(nearest.distance, reach) * ahead;
  bool leaves = false;
  surface.bvh().visit_along(from, path, 1e-6 * reach, [&](int t) {
    const double along = surface.normal(t).dot(path);
    if (!(along > 0.0)) return 1.0;
    const Triangle& v = surface.triangle(t);
    const double part = surface.normal(t).dot(surface.position(v[0]) - from) / along;
    if (!(part >= 0.0 && part <= 1.0)) return 1.0;
    const Vector3 x = from + part * path;
    const TrianglePoint on = closest_on(t, x);
    const Vector3 y = on.weights[0] * surface.position(v[0]) + on.weights[1] * surface.position(v[1]) +
                      on.weights[2] * surface.position(v[2]);
    leaves = leaves || (x - y).norm() <= 1e-6 * reach;
    return leaves ? 0.0 : 1.0;
  });
  return leaves;
}

}}  // namespace palpate
