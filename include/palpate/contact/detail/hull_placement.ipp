// Definitions of hull_placement.hpp.
#pragma once

#include <palpate/contact/detail/hull_placement.hpp>
#include <palpate/contact/detail/hull_separation.ipp>  // its inline functions
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

inline std::array<Vector3, 3> corners_of(const ContactSurface& surface, int t) noexcept {
  const Triangle& v = surface.triangle(t);
  return {surface.position(v[0]), surface.position(v[1]), surface.position(v[2])};
}

/// The first time at which a direction no longer separates hull and triangle by the radius.
inline double until_touching(const HullPath& hull, double radius, const std::array<Vector3, 3>& corner,
                             const Vector3& normal) noexcept {
  const double base = std::max({normal.dot(corner[0]), normal.dot(corner[1]), normal.dot(corner[2])}) + radius;
  double first = infinity;
  for (std::size_t v = 0; v < hull.count; ++v)
    if (const double falls = -normal.dot(hull.path[v]); falls > 0.0)
      first = std::min(first, (normal.dot(hull.start[v]) - base) / falls);
  return first;
}

/// Whether one of the vertices that are lowest along a direction, to a tolerance, moves against it.
inline bool approaches(const HullPath& hull, std::span<const Vector3> now, const Vector3& normal,
                       double tolerance) noexcept {
  const double least = normal.dot(lowest(now, normal)) + tolerance;
  for (std::size_t v = 0; v < hull.count; ++v)
    if (normal.dot(now[v]) <= least && normal.dot(hull.path[v]) < 0.0) return true;
  return false;
}

}  // namespace detail

PALPATE_INLINE HullPath::HullPath(const ConvexHull& hull, const Vector3& from, const Matrix3& rotation,
                                  const Vector3& to, const Matrix3& rotation_to) noexcept
    : count(hull.vertices().size()) {
  for (std::size_t v = 0; v < count; ++v) {
    start[v] = from + rotation * hull.vertices()[v];
    path[v] = to + rotation_to * hull.vertices()[v] - start[v];
  }
}

PALPATE_INLINE double hull_meets_triangle(const HullPath& hull, double radius, const std::array<Vector3, 3>& corner,
                                          const Vector3& normal, double until) noexcept {
  constexpr int steps = 24;
  const double touching = 1e-7 * radius;  // rest of a gap
  double lowest = infinity;
  for (std::size_t v = 0; v < hull.count; ++v) lowest = std::min(lowest, normal.dot(hull.start[v] - corner[0]));
  double at = lowest >= radius ? detail::until_touching(hull, radius, corner, normal) : 0.0;
  std::array<Vector3, ConvexHull::maximum_points> now;
  for (int k = 0; k < steps && at <= until; ++k) {
    for (std::size_t v = 0; v < hull.count; ++v) now[v] = hull.start[v] + at * hull.path[v];
    const std::span<const Vector3> points(now.data(), hull.count);
    const Separation apart = separate(points, corner);
    if (!(apart.distance > 0.0)) return detail::approaches(hull, points, normal, 2.0 * touching) ? at : infinity;
    if (apart.distance - radius <= touching) {
      if (!(apart.normal.dot(normal) > 0.0)) return infinity;  // from behind
      if (detail::approaches(hull, points, apart.normal, 2.0 * touching)) return at;
    }
    const double next = detail::until_touching(hull, radius, corner, apart.normal);
    if (!(next > at)) return infinity;  // it touches, and moves away
    at = next;
  }
  return at <= until ? at : infinity;
}

PALPATE_INLINE double first_touch(const ContactTool& tool, const ContactSurface& surface, const Vector3& from,
                                  const Vector3& position) noexcept {
  const double radius = (1.0 - 1e-6) * tool.radius;  // so that a touching tool that moves away has no hit
  const Vector3 by = rotation_vector(tool.target_rotation * tool.rotation.transpose());
  const int parts = std::max(1, static_cast<int>(std::ceil(by.norm() / 0.25)));
  Vector3 start = from;
  Matrix3 rotation = tool.rotation;
  for (int k = 1; k <= parts; ++k) {
    const double done = static_cast<double>(k) / parts;
    const Vector3 end = from + done * (position - from);
    const Matrix3 rotation_end = k == parts ? tool.target_rotation : Matrix3(rotation_by(done * by) * tool.rotation);
    const HullPath hull(*tool.hull, start, rotation, end, rotation_end);
    const Vector3 middle = start + rotation * tool.hull->middle();
    const Vector3 path = end + rotation_end * tool.hull->middle() - middle;
    double first = 1.0;
    surface.bvh().visit_along(middle, path, tool.hull->radius() + radius, [&](int t) {
      first =
          std::min(first, hull_meets_triangle(hull, radius, detail::corners_of(surface, t), surface.normal(t), first));
      return first;
    });
    if (first < 1.0) return (k - 1 + first) / parts;
    start = end;
    rotation = rotation_end;
  }
  return 1.0;
}

namespace detail {

/// The displacement out of the surface that the deepest vertex of a hull needs, zero if none is deeper than the radius.
inline Vector3 out_of_vertices(const ContactTool& tool, const ContactSurface& surface) noexcept {
  Vector3 move = Vector3::Zero();
  double deepest = (1.0 - 1e-6) * tool.radius;
  for (const Vector3& vertex : tool.hull->vertices()) {
    const Vector3 centre = tool.proxy + tool.rotation * vertex;
    const auto closest = surface.closest_of_body(centre);
    if (!(closest.distance < deepest)) continue;
    deepest = closest.distance;
    move = closest.point + tool.radius * closest.outward - centre;
  }
  return move;
}

/// The same for the triangles near it: the most that one needs which it does not cut, or the least out of one that it
/// cuts.
inline Vector3 out_of_triangles(const ContactTool& tool, const ContactSurface& surface) noexcept {
  const HullPath hull(*tool.hull, tool.proxy, tool.rotation, tool.proxy, tool.rotation);
  const std::span<const Vector3> points(hull.start.data(), hull.count);
  Vector3 move = Vector3::Zero();
  double most = 1e-6 * tool.radius, least = infinity;
  surface.bvh().visit_near(tool.middle(), tool.core_radius() + tool.radius, [&](int t) {
    const auto corner = corners_of(surface, t);
    const Vector3& normal = surface.normal(t);
    const Separation apart = separate(points, corner);
    if (apart.distance > 0.0) {
      const double depth = tool.radius - apart.distance;
      if (least < infinity || !(depth > most) || !(apart.normal.dot(normal) > 0.0)) return;
      most = depth;
      move = depth * apart.normal;
    } else if (const double depth = tool.radius - normal.dot(lowest(points, normal) - corner[0]); depth < least) {
      least = depth;
      move = depth * normal;
    }
  });
  return move;
}

}  // namespace detail

PALPATE_INLINE void place_hull_beside(ContactTool& tool, const ContactSurface& surface) noexcept {
  const auto around = surface.closest_of_body(tool.middle());
  if (around.triangle >= 0 && around.distance >= tool.core_radius() + tool.radius) return;
  for (int round = 0; round < 8; ++round) {
    Vector3 move = detail::out_of_vertices(tool, surface);
    if (max_abs(move) == 0.0) move = detail::out_of_triangles(tool, surface);
    if (max_abs(move) == 0.0) return;
    tool.proxy += move;
  }
}

}}  // namespace palpate
