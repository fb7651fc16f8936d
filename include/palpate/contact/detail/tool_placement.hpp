// Placement of a tool that has no contact yet: next to the surface, or stopped by it on its path.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/convex_hull.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The fraction of `path` at which a sphere whose centre moves from `from` along `path` comes within `radius` of a
/// point; infinity when it does not, or moves away from it.
inline double sphere_meets_point(const Vector3& from, const Vector3& path, double radius,
                                 const Vector3& point) noexcept {
  const Vector3 offset = from - point;
  const double a = path.squaredNorm(), b = offset.dot(path), c = offset.squaredNorm() - radius * radius;
  if (!(b < 0.0)) return infinity;
  if (c <= 0.0) return 0.0;
  const double root = b * b - a * c;
  return root >= 0.0 ? c / (-b + std::sqrt(root)) : infinity;  // the smaller one, without cancellation
}

/// The same for the segment between two points; its ends are not included.
inline double sphere_meets_segment(const Vector3& from, const Vector3& path, double radius, const Vector3& p,
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

/// The same for a triangle reached from its outer side, to which `normal` points.
inline double sphere_meets_triangle(const Vector3& from, const Vector3& path, double radius,
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

/// The fraction of `path` after which a sphere first touches the resting surface from outside; 1 if it does not.
/// Exact: no part is too thin to be detected. Cost: the triangles whose boxes the path crosses.
inline double first_touch(const ContactSurface& surface, const Vector3& from, const Vector3& path,
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

/// Centres of the spheres that represent a capsule in queries of single points: the ends, and between them at most a
/// radius apart. Calls look(coordinate on the axis from the middle [m]) for each.
template <class Look>
void for_each_sphere(const ContactTool& tool, Look&& look) {
  if (tool.half_length == 0.0) {
    look(0.0);
    return;
  }
  const int n = 2 * static_cast<int>(std::ceil(tool.half_length / tool.radius));
  for (int k = 0; k <= n; ++k) look(tool.half_length * (2.0 * k / n - 1.0));
}

/// Places the proxy where the tool does not touch the resting surface: at the position if it is free there, otherwise
/// next to the closest point; a capsule is moved by the displacement that its deepest sphere needs, a few times, a
/// convex tool as place_hull_beside; its hull is that of a ConvexTool. Forces are zero. No allocation.
inline void place_beside(ContactTool& tool, const ContactSurface& surface, const Vector3& position) noexcept {
  tool.force.setZero();
  tool.torque.setZero();
  tool.rotation = tool.target_rotation;
  tool.proxy = position;
  if (tool.hull != nullptr) return tool.hull->placement()->beside(tool, surface);
  const Vector3 axis = tool.axis();
  for (int round = 0; round < (tool.half_length > 0.0 ? 4 : 1); ++round) {
    Vector3 move = Vector3::Zero();
    double deepest = tool.radius;
    for_each_sphere(tool, [&](double s) {
      const Vector3 centre = tool.proxy + s * axis;
      const auto closest = surface.closest_of_body(centre);
      if (closest.distance >= deepest) return;
      deepest = closest.distance;
      move = closest.point + tool.radius * closest.outward - centre;
    });
    if (!(deepest < tool.radius)) return;
    tool.proxy += move;
  }
}

/// Moves and rotates the proxy from `from` towards the position until the tool first touches the resting surface from
/// outside. The hull of a convex tool is that of a ConvexTool. Forces are zero. No allocation.
inline void sweep(ContactTool& tool, const ContactSurface& surface, const Vector3& from,
                  const Vector3& position) noexcept {
  const Vector3 path = position - from, axis = tool.axis(), turn = tool.target_rotation * tool.own_axis - axis;
  double part = 1.0;
  if (tool.hull != nullptr)
    part = tool.hull->placement()->first_touch(tool, surface, from, position);
  else
    for_each_sphere(tool, [&](double s) {  // smaller, so that a touching sphere that moves away has no hit
      part = std::min(part, first_touch(surface, from + s * axis, path + s * turn, (1.0 - 1e-6) * tool.radius));
    });
  tool.proxy = from + part * path;
  const Vector3 by = rotation_vector(tool.target_rotation * tool.rotation.transpose());
  tool.rotation = part < 1.0 ? rotation_by(part * by) * tool.rotation : tool.target_rotation;
  tool.force.setZero();
  tool.torque.setZero();
}

/// Calls look(point) for points of the core, in the tool's own frame, by which a tool inside the body is found: the
/// centre of a sphere, the middle and ends of a capsule, the probes of a hull.
template <class Look>
void for_each_probe(const ContactTool& tool, Look&& look) {
  if (tool.hull != nullptr) {
    for (const Vector3& probe : tool.hull->probes()) look(probe);
    return;
  }
  look(Vector3(0.0, 0.0, 0.0));
  if (tool.half_length == 0.0) return;
  look(-tool.half_length * tool.own_axis);
  look(tool.half_length * tool.own_axis);
}

}}}  // namespace palpate::detail
