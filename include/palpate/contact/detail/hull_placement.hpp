// Convex hulls next to triangles: their distance, and the placement of convex tools next to the surface, or stopped by
// it on their path.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/convex_hull.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A direction that separates a convex hull from a triangle, best the one of their closest points.
struct Separation {
  Vector3 normal = Vector3::Zero();  ///< unit, from the triangle to the hull; zero if they overlap
  double distance = 0.0;  ///< between them along the normal [m]: never more than their distance; 0 if they overlap
};

/// The point of a set that is lowest along a direction.
inline const Vector3& lowest(std::span<const Vector3> points, const Vector3& direction) noexcept {
  std::size_t best = 0;
  double least = infinity;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const double height = direction.dot(points[i]); height < least) least = height, best = i;
  return points[best];
}

/// Up to four points, of which only those are kept that carry the point closest to the origin.
class Simplex {
 public:
  /// Adds a point and returns the point of the simplex closest to the origin, zero if it contains the origin.
  Vector3 add(const Vector3& w) noexcept {
    at_[count_++] = w;
    if (count_ < 4) return reduce(at_, count_);
    const std::array<Vector3, 4> all = at_;
    std::array<Vector3, 4> best_points{};
    std::size_t best_count = 0;
    Vector3 best = Vector3::Zero();
    double least = infinity;
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<Vector3, 4> face{};
      for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != left_out) face[n++] = all[i];
      const Vector3 normal = cross(face[1] - face[0], face[2] - face[0]);
      // The origin on the side of the fourth point: this face is not the closest.
      if (normal.dot(all[left_out] - face[0]) * normal.dot(-face[0]) > 0.0) continue;
      const Vector3 v = reduce(face, 3);
      if (!(v.squaredNorm() < least)) continue;
      least = v.squaredNorm();
      best = v;
      best_points = at_;
      best_count = count_;
    }
    at_ = best_points;
    count_ = best_count;
    return best;
  }
  /// Whether there is no point left because the origin is inside.
  bool contains_origin() const noexcept { return count_ == 0; }

 private:
  /// Keeps the points, 1 to 3 of them, that carry the closest point.
  Vector3 reduce(const std::array<Vector3, 4>& from, std::size_t n) noexcept {
    const Vector3 origin(0.0, 0.0, 0.0);
    std::array<double, 3> weights{1.0, 0.0, 0.0};
    if (n == 2) {
      weights[1] = closest_on_segment(origin, from[0], from[1]);
      weights[0] = 1.0 - weights[1];
    } else if (n == 3) {
      weights = closest_point(origin, from[0], from[1], from[2]).weights;
    }
    const std::array<Vector3, 4> points = from;
    Vector3 closest = Vector3::Zero();
    count_ = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!(weights[i] > 0.0)) continue;
      closest += weights[i] * points[i];
      at_[count_++] = points[i];
    }
    return closest;
  }

  std::array<Vector3, 4> at_{};
  std::size_t count_ = 0;
};

/// The separation of the hull of some points (1 to 64) from a triangle (Gilbert, Johnson and Keerthi 1988; the closest
/// point of a simplex from the closest points of its triangles). At most 32 rounds, each of the work of one support
/// query; a result of fewer rounds than needed is still a lower bound. No allocation.
inline Separation separate(std::span<const Vector3> points, const std::array<Vector3, 3>& corner) noexcept {
  Simplex simplex;
  Separation best;
  Vector3 v = simplex.add(points.front() - corner[0]);
  for (int round = 0; round < 32; ++round) {
    const double length = v.norm();
    if (simplex.contains_origin() || !(length > 0.0)) return {};
    const Vector3 w = lowest(points, v) - lowest(corner, -v);
    const double least = v.dot(w) / length;
    if (least > best.distance) best = {v / length, least};
    if (length - least <= 1e-12 * length) break;
    v = simplex.add(w);
    if (!(v.norm() < length)) break;  // rounding: no closer any more
  }
  return best;
}

/// The vertices of a hull while a tool moves: each along its own straight path.
struct HullPath {
  std::array<Vector3, ConvexHull::maximum_points> start, path;
  std::size_t count = 0;

  HullPath(const ConvexHull& hull, const Vector3& from, const Matrix3& rotation, const Vector3& to,
           const Matrix3& rotation_to) noexcept
      : count(hull.vertices().size()) {
    for (std::size_t v = 0; v < count; ++v) {
      start[v] = from + rotation * hull.vertices()[v];
      path[v] = to + rotation_to * hull.vertices()[v] - start[v];
    }
  }
};

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

/// The fraction of the path after which the rounded hull first touches a triangle from its outer side, to which
/// `normal` points; infinity when it does not before `until`. Conservative advancement (Mirtich 1996): every step ends
/// where a direction that separates hull and triangle has less than the radius left, so no step passes the first
/// contact. At most 24 steps; a path that needs more ends earlier.
inline double hull_meets_triangle(const HullPath& hull, double radius, const std::array<Vector3, 3>& corner,
                                  const Vector3& normal, double until) noexcept {
  constexpr int steps = 24;
  const double touching = 1e-7 * radius;  // rest of a gap
  double lowest = infinity;
  for (std::size_t v = 0; v < hull.count; ++v) lowest = std::min(lowest, normal.dot(hull.start[v] - corner[0]));
  double at = lowest >= radius ? until_touching(hull, radius, corner, normal) : 0.0;
  std::array<Vector3, ConvexHull::maximum_points> now;
  for (int k = 0; k < steps && at <= until; ++k) {
    for (std::size_t v = 0; v < hull.count; ++v) now[v] = hull.start[v] + at * hull.path[v];
    const std::span<const Vector3> points(now.data(), hull.count);
    const Separation apart = separate(points, corner);
    if (!(apart.distance > 0.0)) return approaches(hull, points, normal, 2.0 * touching) ? at : infinity;
    if (apart.distance - radius <= touching) {
      if (!(apart.normal.dot(normal) > 0.0)) return infinity;  // from behind
      if (approaches(hull, points, apart.normal, 2.0 * touching)) return at;
    }
    const double next = until_touching(hull, radius, corner, apart.normal);
    if (!(next > at)) return infinity;  // it touches, and moves away
    at = next;
  }
  return at <= until ? at : infinity;
}

/// The fraction of the way to `position` and target_rotation after which a convex tool whose proxy is at `from` first
/// touches the resting surface from outside; 1 if it does not. No part is too thin to be detected, whatever the size of
/// the faces. A rotation is divided into parts of at most a quarter radian, in which vertices move straight. Cost: the
/// triangles near the path.
inline double first_touch(const ContactTool& tool, const ContactSurface& surface, const Vector3& from,
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
      first = std::min(first, hull_meets_triangle(hull, radius, corners_of(surface, t), surface.normal(t), first));
      return first;
    });
    if (first < 1.0) return (k - 1 + first) / parts;
    start = end;
    rotation = rotation_end;
  }
  return 1.0;
}

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

/// Moves a convex tool beside the resting surface: out by its deepest vertex, then by the triangle that is deepest in
/// its rounded faces, at most eight times. Cost: closest points for its vertices, and the triangles near it.
inline void place_hull_beside(ContactTool& tool, const ContactSurface& surface) noexcept {
  const auto around = surface.closest_of_body(tool.middle());
  if (around.triangle >= 0 && around.distance >= tool.core_radius() + tool.radius) return;
  for (int round = 0; round < 8; ++round) {
    Vector3 move = out_of_vertices(tool, surface);
    if (max_abs(move) == 0.0) move = out_of_triangles(tool, surface);
    if (max_abs(move) == 0.0) return;
    tool.proxy += move;
  }
}

/// What a ConvexTool gives its hull.
inline constexpr HullPlacement hull_placement{&place_hull_beside, &first_touch};

}}}  // namespace palpate::detail
