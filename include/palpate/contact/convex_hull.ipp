// Definitions of convex_hull.hpp.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Vertices and faces of a convex hull. Coplanar triangles are one polygon.
struct HullPolygons {
  int dimension = 0;  ///< 0: a point, 1: a segment, 2: a plane polygon, 3: a polyhedron
  std::vector<Vector3> vertices;
  /// Vertices of every face, anticlockwise seen from outside; of a plane polygon both sides.
  std::vector<std::vector<int>> faces;
};

/// Points closer than this part of the size of all points are one point, or on one plane.
inline constexpr double hull_tolerance = 1e-9;
/// Below this part of its length a hull has no width; below this part of its length and width it is plane.
inline constexpr double hull_flatness = 1e-6;

/// The convex hull of 1 to 64 points. Every plane through three points that has all others on one side is a face; for
/// so few points no faster construction is needed. Throws bad_argument for none or more than 64 points (value,
/// threshold), points that are not finite (ids: the points), and points whose hull is not closed because it has
/// features smaller than a millionth of it. Allocates; for set-up.
HullPolygons hull_polygons(std::span<const Vector3> points);

/// The points of a hull under construction.
struct HullPoints {
  std::vector<Vector3> x;
  double size = 0.0;  // diagonal of their box [m]

  const Vector3& at(int i) const noexcept { return x[static_cast<std::size_t>(i)]; }
  int count() const noexcept { return static_cast<int>(x.size()); }
  double tolerance() const noexcept { return hull_tolerance * size; }

  /// The point with the largest value of `measure`.
  template <class Measure>
  int farthest(Measure&& measure) const {
    int best = 0;
    for (int i = 1; i < count(); ++i)
      if (measure(at(i)) > measure(at(best))) best = i;
    return best;
  }
};

inline HullPoints distinct_points(std::span<const Vector3> points) {
  SetupProblem problem;
  std::vector<std::int64_t> bad;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite() || max_abs(points[i]) > 1e6) bad.push_back(static_cast<std::int64_t>(i));
  problem.set_ids(bad);
  if (!bad.empty()) problem.what = "a point of a convex hull is not finite, or farther than 1e6 m from the origin";
  if (points.empty() || points.size() > 64) {
    problem.what = "a convex hull of " + std::to_string(points.size()) + " points";
    problem.hint = "Give 1 to 64: the outer corners of the tool are enough";
    problem.value = static_cast<double>(points.size());
    problem.threshold = 64.0;
  }
  if (!problem.what.empty()) raise(std::move(problem));
  HullPoints made;
  Box box;
  for (const Vector3& p : points) box.include(p);
  made.size = box.size().norm();
  for (const Vector3& p : points)
    if (std::none_of(made.x.begin(), made.x.end(),
                     [&](const Vector3& q) { return (p - q).norm() <= made.tolerance(); }))
      made.x.push_back(p);
  return made;
}

/// The corners of the plane convex hull of some points, anticlockwise about `normal` (Andrew's monotone chain). Points
/// on its sides are no corners.
inline std::vector<int> plane_hull(const HullPoints& points, std::vector<int> on, const Vector3& normal) {
  const Vector3 other = std::abs(normal[0]) < 0.7 ? Vector3(1.0, 0.0, 0.0) : Vector3(0.0, 1.0, 0.0);
  const Vector3 u = cross(other, normal).normalized(), v = cross(normal, u);
  const auto x = [&](int i) { return u.dot(points.at(i)); };
  const auto y = [&](int i) { return v.dot(points.at(i)); };
  std::sort(on.begin(), on.end(), [&](int a, int b) { return x(a) < x(b) || (x(a) == x(b) && y(a) < y(b)); });
  const auto is_corner = [&](int a, int b, int c) {  // whether b is to the right of the line from a to c
    const double dx = x(c) - x(a), dy = y(c) - y(a);
    return dy * (x(b) - x(a)) - dx * (y(b) - y(a)) > points.tolerance() * std::hypot(dx, dy);
  };
  std::vector<int> hull;
  for (const bool back : {false, true}) {
    const std::size_t first = hull.size();
    for (const int i : on) {
      while (hull.size() >= first + 2 && !is_corner(hull[hull.size() - 2], hull.back(), i)) hull.pop_back();
      hull.push_back(i);
    }
    hull.pop_back();  // the first of the way back
    if (!back) std::reverse(on.begin(), on.end());
  }
  return hull;
}

/// The faces of a hull with volume.
inline std::vector<std::vector<int>> find_faces(const HullPoints& points) {
  std::vector<std::vector<int>> faces;
  std::vector<std::uint64_t> found;  // the points on each face, one bit each
  const auto has = [](std::uint64_t set, int i) { return (set >> i & 1u) != 0; };
  const auto consider = [&](int i, int j, int k) {
    for (const std::uint64_t face : found)
      if (has(face, i) && has(face, j) && has(face, k)) return;
    const Vector3 side = points.at(j) - points.at(i), area = cross(side, points.at(k) - points.at(i));
    const double longest =
        std::max({side.norm(), (points.at(k) - points.at(i)).norm(), (points.at(k) - points.at(j)).norm()});
    if (!(area.norm() > hull_flatness * points.size * longest)) return;  // its plane is not known
    const Vector3 normal = area.normalized();
    std::vector<int> on;
    std::uint64_t set = 0;
    double above = 0.0, below = 0.0;
    for (int p = 0; p < points.count(); ++p) {
      const double height = normal.dot(points.at(p) - points.at(i));
      above = std::max(above, height);
      below = std::max(below, -height);
      if (above > points.tolerance() && below > points.tolerance()) return;
      if (std::abs(height) > points.tolerance()) continue;
      on.push_back(p);
      set |= std::uint64_t{1} << p;
    }
    found.push_back(set);
    faces.push_back(plane_hull(points, std::move(on), above > points.tolerance() ? Vector3(-normal) : normal));
  };
  for (int i = 0; i < points.count(); ++i)
    for (int j = i + 1; j < points.count(); ++j)
      for (int k = j + 1; k < points.count(); ++k) consider(i, j, k);
  return faces;
}

/// Refuses faces that do not close: each side must be one of exactly one other face, in the opposite direction.
inline void require_closed(const HullPolygons& hull) {
  int sides = 0, matched = 0;
  const auto each_side = [&](auto&& visit) {
    for (const std::vector<int>& face : hull.faces)
      for (std::size_t i = 0; i < face.size(); ++i) visit(face[i], face[(i + 1) % face.size()]);
  };
  each_side([&](int a, int b) {
    ++sides;
    each_side([&](int c, int d) { matched += a == d && b == c; });
  });
  const int euler = static_cast<int>(hull.vertices.size()) - sides / 2 + static_cast<int>(hull.faces.size());
  if (matched == sides && euler == 2) return;
  raise(SetupErrorKind::bad_argument, "the convex hull of the points is not closed",
        "It has edges shorter, or faces flatter against each other, than a millionth of its size: merge such points");
}

inline void keep_corners(const HullPoints& points, HullPolygons& hull) {
  std::vector<int> number(points.x.size(), -1);
  for (std::vector<int>& face : hull.faces)
    for (int& corner : face) {
      int& own = number[static_cast<std::size_t>(corner)];
      if (own < 0) {
        own = static_cast<int>(hull.vertices.size());
        hull.vertices.push_back(points.at(corner));
      }
      corner = own;
    }
}

PALPATE_INLINE HullPolygons hull_polygons(std::span<const Vector3> all) {
  const HullPoints points = distinct_points(all);
  HullPolygons hull;
  const Vector3 a = points.at(points.farthest([&](const Vector3& p) { return (p - points.at(0)).norm(); }));
  const Vector3 b = points.at(points.farthest([&](const Vector3& p) { return (p - a).norm(); }));
  const double length = (b - a).norm();
  hull.vertices = {a};
  if (!(length > 0.0)) return hull;
  hull.dimension = 1;
  hull.vertices = {a, b};
  const Vector3 along = (b - a) / length;
  const auto beside = [&](const Vector3& p) { return cross(along, p - a).norm(); };
  const Vector3 c = points.at(points.farthest(beside));
  if (!(beside(c) > hull_flatness * length)) return hull;
  hull.dimension = 2;
  hull.vertices.clear();
  const Vector3 normal = cross(along, c - a).normalized();
  const auto above = [&](const Vector3& p) { return std::abs(normal.dot(p - a)); };
  if (above(points.at(points.farthest(above))) > hull_flatness * length) {
    hull.dimension = 3;
    hull.faces = find_faces(points);
  } else {
    std::vector<int> on;
    for (int i = 0; i < points.count(); ++i) on.push_back(i);
    hull.faces = {plane_hull(points, on, normal)};
    hull.faces.emplace_back(hull.faces[0].rbegin(), hull.faces[0].rend());
  }
  keep_corners(points, hull);
  require_closed(hull);
  return hull;
}

}  // namespace detail

PALPATE_INLINE ConvexHull::ConvexHull(std::span<const Vector3> points) : closest_(&find_closest) {
  detail::HullPolygons hull = detail::hull_polygons(points);
  dimension_ = hull.dimension;
  vertices_ = std::move(hull.vertices);
  for (const std::vector<int>& face : hull.faces) add_face(face);
  if (hull.faces.empty())
    edges_.push_back({vertices_.front(), vertices_.back() - vertices_.front(), 0.0, {-1, -1}});
  else
    add_edges(hull.faces);
  for (Edge& e : edges_)
    if (e.along.squaredNorm() > 0.0) e.inverse_square = 1.0 / e.along.squaredNorm();
  bound();
}

PALPATE_INLINE void ConvexHull::add_face(std::span<const int> corners) {
  const auto corner = [&](std::size_t i) -> const Vector3& {
    return vertices_[static_cast<std::size_t>(corners[i % corners.size()])];
  };
  Vector3 area = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area += cross(corner(i) - corner(0), corner(i + 1) - corner(0));
    triangles_.push_back({corners[0], corners[i], corners[i + 1]});
  }
  Face face{area.normalized(), -infinity, static_cast<int>(sides_.size()), 0};
  for (const Vector3& v : vertices_) face.offset = std::max(face.offset, face.normal.dot(v));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3 outward = cross(corner(i + 1) - corner(i), face.normal).normalized();
    sides_.push_back({outward, std::max(outward.dot(corner(i)), outward.dot(corner(i + 1)))});
  }
  face.end = static_cast<int>(sides_.size());
  faces_.push_back(face);
}

PALPATE_INLINE void ConvexHull::add_edges(const std::vector<std::vector<int>>& faces) {
  const auto face_with = [&](int a, int b) {
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (std::size_t i = 0; i < faces[f].size(); ++i)
        if (faces[f][i] == a && faces[f][(i + 1) % faces[f].size()] == b) return static_cast<int>(f);
    return -1;
  };
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      const int a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
      const Vector3& start = vertices_[static_cast<std::size_t>(a)];
      if (a < b)
        edges_.push_back(
            {start, vertices_[static_cast<std::size_t>(b)] - start, 0.0, {static_cast<int>(f), face_with(b, a)}});
    }
}

PALPATE_INLINE void ConvexHull::bound() {
  for (const Vector3& v : vertices_) middle_ += v / static_cast<double>(vertices_.size());
  for (const Vector3& v : vertices_) {
    radius_ = std::max(radius_, (v - middle_).norm());
    extent_ = std::max(extent_, v.norm());
  }
  probes_ = {middle_};
  while (probes_.size() < 1 + std::min<std::size_t>(8, vertices_.size())) {
    const auto apart = [&](const Vector3& v) {
      double least = infinity;
      for (const Vector3& p : probes_) least = std::min(least, (v - p).squaredNorm());
      return least;
    };
    probes_.push_back(*std::max_element(vertices_.begin(), vertices_.end(),
                                        [&](const Vector3& a, const Vector3& b) { return apart(a) < apart(b); }));
  }
}

/// Whether the foot of the perpendicular from p to the plane of a face is in the face.
inline bool ConvexHull::covers(const Face& face, const Vector3& p) const noexcept {
  for (int i = face.first; i < face.end; ++i)
    if (sides_[static_cast<std::size_t>(i)].height(p) > 0.0) return false;
  return true;
}

PALPATE_INLINE ConvexHull::Closest ConvexHull::find_closest(const ConvexHull& hull, const Vector3& p) noexcept {
  std::array<double, maximum_faces> heights;
  heights[0] = -infinity;
  std::size_t top = 0;
  for (std::size_t f = 0; f < hull.faces_.size(); ++f) {
    heights[f] = hull.faces_[f].height(p);
    if (heights[f] > heights[top]) top = f;
  }
  const bool inside = hull.dimension_ == 3 && heights[top] <= 0.0;
  const Vector3 normal = hull.faces_.empty() ? Vector3(0.0, 0.0, 1.0) : hull.faces_[top].normal;
  if (inside || (!hull.faces_.empty() && hull.covers(hull.faces_[top], p)))
    return {p - heights[top] * normal, normal, heights[top]};
  const double rounding = 1e-12 * hull.radius_;
  Vector3 nearest = hull.edges_.front().start;
  double least = infinity;
  for (const Edge& e : hull.edges_) {
    const auto is_hidden = [&](int face) { return heights[static_cast<std::size_t>(face)] < -rounding; };
    if (e.faces[0] >= 0 && is_hidden(e.faces[0]) && is_hidden(e.faces[1])) continue;
    const Vector3 offset = p - e.start;
    const Vector3 foot = std::clamp(offset.dot(e.along) * e.inverse_square, 0.0, 1.0) * e.along;
    const double square = (offset - foot).squaredNorm();
    if (!(square < least)) continue;
    least = square;
    nearest = e.start + foot;
  }
  const double distance = std::sqrt(least);
  // On an edge the direction from it is undefined.
  return {nearest, distance > rounding ? Vector3((p - nearest) / distance) : normal, distance};
}

}}  // namespace palpate
