// Definitions of interface_rows.hpp.
#pragma once

#include <palpate/contact/detail/interface_rows.hpp>
#include <palpate/contact/detail/line_crossing.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

namespace interface_geometry {

using Point2 = std::array<double, 2>;

/// Twice the signed area of a triangle.
inline double turn(const Point2& a, const Point2& b, const Point2& c) noexcept {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
inline std::array<double, 3> weights(const std::array<Point2, 3>& triangle, const Point2& p) noexcept {
  const double all = turn(triangle[0], triangle[1], triangle[2]);
  const double a = turn(p, triangle[1], triangle[2]) / all, b = turn(triangle[0], p, triangle[2]) / all;
  return {a, b, 1.0 - a - b};
}
inline bool contains(const std::array<Point2, 3>& triangle, const Point2& p) noexcept {
  constexpr double rounding = 1e-9;
  const auto w = weights(triangle, p);
  return w[0] > -rounding && w[1] > -rounding && w[2] > -rounding;
}

/// Cuts a convex polygon of `count` corners by a line; what is left of it stays (Sutherland and Hodgman 1974).
inline int clip(std::array<Point2, 9>& polygon, int count, const Point2& a, const Point2& b) noexcept {
  std::array<Point2, 9> cut{};
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const Point2 &p = polygon[static_cast<std::size_t>(i)], &q = polygon[static_cast<std::size_t>((i + 1) % count)];
    const double of_p = turn(a, b, p), of_q = turn(a, b, q);
    if (of_p >= 0.0) cut[static_cast<std::size_t>(kept++)] = p;
    if ((of_p > 0.0 && of_q < 0.0) || (of_p < 0.0 && of_q > 0.0)) {
      const double part = of_p / (of_p - of_q);
      cut[static_cast<std::size_t>(kept++)] = {p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])};
    }
  }
  polygon = cut;
  return kept;
}

inline double area_of(const std::array<Point2, 9>& polygon, int count) noexcept {
  double twice = 0.0;
  for (int i = 1; i + 1 < count; ++i)
    twice += turn(polygon[0], polygon[static_cast<std::size_t>(i)], polygon[static_cast<std::size_t>(i + 1)]);
  return 0.5 * twice;
}

inline Point2 middle_of(const std::array<Point2, 9>& polygon, int count) noexcept {
  Point2 sum{};
  for (int i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 2; ++k) sum[k] += polygon[static_cast<std::size_t>(i)][k];
  return {sum[0] / count, sum[1] / count};
}

inline double interpolated(const std::array<double, 3>& values, const std::array<double, 3>& w) noexcept {
  return w[0] * values[0] + w[1] * values[1] + w[2] * values[2];
}

inline bool share_vertex(const Triangle& a, const Triangle& b) noexcept {
  return std::ranges::any_of(a, [&](int v) { return std::ranges::find(b, v) != b.end(); });
}

}  // namespace interface_geometry

PALPATE_INLINE void InterfaceRows::find_overlaps(const InterfaceSurface& first, const InterfaceSurface& second, int t,
                                                 double reach) {
  constexpr double opposite = -0.2;  // cosine between the normals of two facets
  constexpr double least_area = 1e-12;
  const Triangle& own = first.triangles[static_cast<std::size_t>(t)];
  const auto flat = [&](const Vector3& p) {
    const Vector3 d = p - corner_[0];
    return Point2{d.dot(axis_[0]), d.dot(axis_[1])};
  };
  const std::array<Point2, 3> facet{flat(corner_[0]), flat(corner_[1]), flat(corner_[2])};
  const double twice = interface_geometry::turn(facet[0], facet[1], facet[2]);
  const double depth = first.depths[static_cast<std::size_t>(t)];
  const auto visit = [&](int other) {
    if (first.body == second.body) {
      if (other <= t || interface_geometry::share_vertex(own, second.triangles[static_cast<std::size_t>(other)]))
        return 1.0;
      if (!first.parts.empty() &&
          first.parts[static_cast<std::size_t>(t)] == first.parts[static_cast<std::size_t>(other)])
        return 1.0;
    }
    const Triangle& v = second.triangles[static_cast<std::size_t>(other)];
    std::array<Vector3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = second.positions[static_cast<std::size_t>(v[k])];
    const Vector3 across = cross(p[1] - p[0], p[2] - p[0]);
    if (!(across.dot(normal_) < opposite * across.norm())) return 1.0;
    Overlap o{other};
    o.normal = across.normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      o.projected[k] = flat(p[k]);
      o.heights[k] = (p[k] - corner_[0]).dot(normal_);
    }
    for (std::size_t k = 0; k < 3; ++k) o.polygon[k] = facet[k];
    o.corners = 3;
    // Seen from its other side, the corners of the other facet are in clockwise order.
    for (std::size_t k = 0; k < 3 && o.corners > 2; ++k)
      o.corners = interface_geometry::clip(o.polygon, o.corners, o.projected[(k + 1) % 3], o.projected[k]);
    if (o.corners < 3) return 1.0;
    o.area = interface_geometry::area_of(o.polygon, o.corners);
    if (!(o.area > least_area * twice)) return 1.0;
    const Point2 middle = interface_geometry::middle_of(o.polygon, o.corners);
    o.gap = interface_geometry::interpolated(o.heights, interface_geometry::weights(o.projected, middle));
    const double deepest = std::min(depth, second.depths[static_cast<std::size_t>(other)]);
    if (o.gap <= reach && o.gap >= -deepest) overlaps_.push_back(o);
    return 1.0;
  };
  const Vector3 centre = (corner_[0] + corner_[1] + corner_[2]) / 3.0;
  double radius = 0.0;
  for (const Vector3& c : corner_) radius = std::max(radius, (c - centre).norm());
  second.bvh->visit_along(centre + reach * normal_, -(reach + depth) * normal_, radius, visit);
}

/// Overlaps behind nearer ones are dropped.
PALPATE_INLINE void InterfaceRows::keep_nearest(double area) {
  std::ranges::sort(overlaps_, [](const Overlap& a, const Overlap& b) {
    return std::pair(std::abs(a.gap), a.triangle) < std::pair(std::abs(b.gap), b.triangle);
  });
  double sum = 0.0;
  for (const Overlap& o : overlaps_) sum += o.area;
  if (!(sum > (1.0 + 1e-9) * area)) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < overlaps_.size(); ++k) {
    const Point2 middle = interface_geometry::middle_of(overlaps_[k].polygon, overlaps_[k].corners);
    const bool is_behind =
        std::any_of(overlaps_.begin(), overlaps_.begin() + static_cast<std::ptrdiff_t>(kept),
                    [&](const Overlap& nearer) { return interface_geometry::contains(nearer.projected, middle); });
    if (!is_behind) overlaps_[kept++] = overlaps_[k];
  }
  overlaps_.resize(kept);
}

/// The products of shape functions are quadratic on the overlap: three points per triangle integrate them exactly.
PALPATE_INLINE void InterfaceRows::integrate(const InterfaceSurface& first, const InterfaceSurface& second, int t,
                                             const Overlap& o) {
  const Triangle& own = first.triangles[static_cast<std::size_t>(t)];
  const Triangle& other = second.triangles[static_cast<std::size_t>(o.triangle)];
  const Vector3 e1 = corner_[1] - corner_[0], e2 = corner_[2] - corner_[0];
  const std::array<Point2, 3> facet{
      Point2{0.0, 0.0}, {e1.dot(axis_[0]), e1.dot(axis_[1])}, {e2.dot(axis_[0]), e2.dot(axis_[1])}};
  std::array<std::array<double, 3>, 3> with_own{}, with_other{};
  std::array<double, 3> area{};
  for (int i = 1; i + 1 < o.corners; ++i) {
    const std::array<Point2, 3> part{o.polygon[0], o.polygon[static_cast<std::size_t>(i)],
                                     o.polygon[static_cast<std::size_t>(i + 1)]};
    const double weight = interface_geometry::turn(part[0], part[1], part[2]) / 6.0;
    for (std::size_t q = 0; q < 3; ++q) {
      Point2 p{};
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 2; ++k) p[k] += (c == q ? 2.0 / 3.0 : 1.0 / 6.0) * part[c][k];
      const auto n = interface_geometry::weights(facet, p), m = interface_geometry::weights(o.projected, p);
      for (std::size_t b = 0; b < 3; ++b) {
        area[b] += weight * n[b];
        for (std::size_t a = 0; a < 3; ++a) {
          with_own[b][a] += weight * n[b] * n[a];
          with_other[b][a] += weight * n[b] * m[a];
        }
      }
    }
  }
  for (std::size_t b = 0; b < 3; ++b) {
    Sum& sum = sums_[static_cast<std::size_t>(own[b])];
    if (sum.terms.empty()) touched_.push_back(own[b]);
    sum.area += area[b];
    sum.normal += area[b] * normal_;
    sum.opposite += area[b] * o.normal;
    for (std::size_t a = 0; a < 3; ++a) {
      sum.add(first.body, own[a], -with_own[b][a]);
      sum.add(second.body, other[a], with_other[b][a]);
    }
  }
}

PALPATE_INLINE void InterfaceRows::Sum::add(int body, int vertex, double weight) {
  for (InterfaceTerm& t : terms)
    if (t.vertex == vertex && t.body == body) {
      t.weight += weight;
      return;
    }
  terms.push_back({body, vertex, weight});
}

/// The sum of unit normals is shorter than their number where facets differ: 30 degrees count a tenth.
PALPATE_INLINE Vector3 InterfaceRows::Sum::direction() const noexcept {
  const auto weighted = [&](const Vector3& sum) {
    return Vector3(std::pow(sum.norm() / area, 16.0) * sum.normalized());
  };
  const Vector3 all = weighted(normal) - weighted(opposite);
  return all.squaredNorm() > 0.0 ? Vector3(all.normalized()) : Vector3(normal.normalized());
}

PALPATE_INLINE void InterfaceRows::finish(const InterfaceSurface& first, const InterfaceSurface& second) {
  constexpr double least_part = 1e-6;  // of the area around a vertex: less has no row
  for (const int vertex : touched_) {
    Sum& sum = sums_[static_cast<std::size_t>(vertex)];
    if (sum.area > least_part * sum.facets) {
      InterfaceRow row{{first.body, second.body, vertex}, sum.direction(), sum.area};
      std::ranges::sort(sum.terms, {}, [](const InterfaceTerm& t) { return std::pair(t.body, t.vertex); });
      for (InterfaceTerm& t : sum.terms) t.weight /= sum.area;
      row.terms.assign(sum.terms.begin(), sum.terms.end());
      rows_.push_back(std::move(row));
    }
    sum.terms.clear();
    sum.normal.setZero();
    sum.opposite.setZero();
    sum.area = sum.facets = 0.0;
  }
  touched_.clear();
}

PALPATE_INLINE void InterfaceRows::add(const InterfaceSurface& first, const InterfaceSurface& second, double reach) {
  sums_.resize(std::max(sums_.size(), first.positions.size()));
  for (int t = 0; t < static_cast<int>(first.triangles.size()); ++t) {
    const Triangle& own = first.triangles[static_cast<std::size_t>(t)];
    for (std::size_t k = 0; k < 3; ++k) corner_[k] = first.positions[static_cast<std::size_t>(own[k])];
    const Vector3 across = cross(corner_[1] - corner_[0], corner_[2] - corner_[0]);
    const double twice = across.norm();
    if (!(twice > 0.0)) continue;
    normal_ = across / twice;
    axis_[0] = (corner_[1] - corner_[0]).normalized();
    axis_[1] = cross(normal_, axis_[0]);
    overlaps_.clear();
    find_overlaps(first, second, t, reach);
    if (overlaps_.empty()) continue;
    keep_nearest(0.5 * twice);
    for (const Overlap& o : overlaps_) integrate(first, second, t, o);
    for (const int v : own) sums_[static_cast<std::size_t>(v)].facets += twice / 6.0;
  }
  finish(first, second);
}

PALPATE_INLINE std::vector<double> interface_depths(std::span<const Triangle> triangles,
                                                    std::span<const Vector3> positions,
                                                    std::span<const Triangle> boundary,
                                                    std::span<const Vector3> of_boundary, const Bvh& bvh) {
  const Vector3 size = triangles.empty() ? Vector3(0.0, 0.0, 0.0) : bvh.bounds().size();
  constexpr double least = 1e-6;  // of a facet: the facet itself
  std::vector<double> depths;
  depths.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const Vector3 &a = positions[static_cast<std::size_t>(t[0])], &b = positions[static_cast<std::size_t>(t[1])],
                  &c = positions[static_cast<std::size_t>(t[2])];
    const Vector3 centre = (a + b + c) / 3.0, across = cross(b - a, c - a);
    const double length = std::sqrt(across.norm());
    double part = 1.0;
    const Vector3 path = across.normalized() * -size.norm();
    bvh.visit_along(centre, path, 0.0, [&](int other) {
      const Triangle& o = boundary[static_cast<std::size_t>(other)];
      const auto at = [&](std::size_t k) { return of_boundary[static_cast<std::size_t>(o[k])]; };
      const auto crossing = cross_triangle(centre, path, at(0), at(1), at(2));
      if (crossing && crossing->is_along_normal && crossing->part * size.norm() > least * length)
        part = std::min(part, crossing->part);
      return part;
    });
    depths.push_back(0.5 * part * size.norm());
  }
  return depths;
}

}}}  // namespace palpate::detail
