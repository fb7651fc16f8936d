// How much of the edge of a blade is in tissue.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/detail/triangle.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A point as seen along a line: beside the line, and along it.
struct SeenPoint {
  double x, y, along;
};

/// The side of the edge from p to q on which the line passes: the sign of p.x q.y - p.y q.x, which rounding cannot
/// change. If the line passes through the edge, that of a line beside it, the same one for all edges; 0 for an edge
/// along the line. The line therefore goes through exactly one of two triangles with a common edge, or through both or
/// none.
inline int side_of(const SeenPoint& p, const SeenPoint& q) noexcept {
  const double a = p.x * q.y, b = p.y * q.x;
  if (a != b) return a > b ? 1 : -1;
  const double rest_a = std::fma(p.x, q.y, -a), rest_b = std::fma(p.y, q.x, -b);
  if (rest_a != rest_b) return rest_a > rest_b ? 1 : -1;
  if (p.y != q.y) return p.y > q.y ? 1 : -1;
  return p.x == q.x ? 0 : q.x > p.x ? 1 : -1;
}

/// The crossings of the line of an edge with a closed boundary.
class EdgeCrossings {
 public:
  explicit EdgeCrossings(double length) : length_(length) {}

  /// `sense`: 1 if the corners are in the order of the outward triangle, -1 if they are in the opposite one.
  void add_triangle(const std::array<SeenPoint, 3>& p, int sense) noexcept {
    const int side = side_of(p[0], p[1]);
    if (side == 0 || side_of(p[1], p[2]) != side || side_of(p[2], p[0]) != side) return;
    double sum = 0.0, along = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const SeenPoint &q = p[(i + 1) % 3], &r = p[(i + 2) % 3];
      const double weight = std::max(0.0, side * (q.x * r.y - q.y * r.x));
      sum += weight;
      along += weight * p[i].along;
    }
    add(sum > 0.0 ? along / sum : (p[0].along + p[1].along + p[2].along) / 3.0, -side * sense);
  }
  /// Length of the edge in tissue.
  double inside() noexcept {
    if (count_ > most) return std::clamp(sum_, 0.0, length_);
    const auto end = crossings_.begin() + count_;
    std::sort(crossings_.begin(), end);
    double inside = 0.0, from = 0.0;
    int depth = before_;
    for (auto c = crossings_.begin(); c != end; ++c) {
      if (depth > 0) inside += c->first - from;
      from = c->first;
      depth += c->second;
    }
    return depth > 0 ? inside + (length_ - from) : inside;
  }

 private:
  static constexpr int most = 64;

  /// `change`: 1 into tissue, -1 out of it.
  void add(double at, int change) noexcept {
    if (!(at < length_)) return;
    sum_ += change * (length_ - std::max(at, 0.0));
    if (!(at > 0.0))
      before_ += change;
    else if (count_++ < most)
      crossings_[static_cast<std::size_t>(count_ - 1)] = {at, change};
  }

  double length_, sum_ = 0.0;  // sum_: the length, if no tissue is pressed into tissue
  int before_ = 0, count_ = 0;
  std::array<std::pair<double, int>, most> crossings_;  // within the edge
};

/// Corners of a triangle in an order that depends on their positions only, so that coincident walls are crossed at
/// exactly the same point; returns 1 if the order is that of the triangle, -1 if it is the opposite one.
inline int sort_corners(std::array<const Vector3*, 3>& corner) noexcept {
  int sense = 1;
  for (const std::size_t i : {0u, 1u, 0u}) {
    const Vector3 &a = *corner[i], &b = *corner[i + 1];
    if (!std::lexicographical_compare(b.data(), b.data() + 3, a.data(), a.data() + 3)) continue;
    std::swap(corner[i], corner[i + 1]);
    sense = -sense;
  }
  return sense;
}

/// For a closed surface: the least of three lines beside the edge, so that an edge in the plane of a facet is outside
/// and one between the walls of a slit that only rounding opens is inside.
inline double length_inside(const ContactSurface& surface, const Vector3& a, const Vector3& b) noexcept {
  const double length = (b - a).norm();
  if (surface.triangles().empty() || !(length > 0.0)) return 0.0;
  const Vector3 ahead = (b - a) / length;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(ahead[k]) < std::abs(ahead[axis])) axis = k;
  const Vector3 x = cross(ahead, Vector3(Vector3::Unit(axis))).normalized(), y = cross(ahead, x);
  const Box& box = surface.bvh().bounds();
  const double size = box.size().norm(), back = std::max(0.0, ahead.dot(a - 0.5 * (box.low + box.high)) + size);
  const double beside = 1e-9 * size;
  const double margin = 2.0 * beside + 1e-15 * (a.norm() + b.norm() + size);  // rounding of a far or long edge
  // The three are a third of a turn apart, at an angle from the axes: none of them is in the plane of a slit that is.
  constexpr std::array<std::array<double, 2>, 3> offset{{{0.9888, 0.1494}, {-0.6238, 0.7816}, {-0.3650, -0.9310}}};
  std::array<EdgeCrossings, 3> lines{EdgeCrossings(length), EdgeCrossings(length), EdgeCrossings(length)};
  surface.bvh().visit_along(a - back * ahead, b - a + back * ahead, margin, [&](int t) {
    const Triangle& v = surface.triangle(t);
    std::array<const Vector3*, 3> corner{&surface.position(v[0]), &surface.position(v[1]), &surface.position(v[2])};
    const int sense = sort_corners(corner);
    std::array<SeenPoint, 3> seen;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 from = *corner[i] - a;
      seen[i] = {from.dot(x), from.dot(y), from.dot(ahead)};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<SeenPoint, 3> moved = seen;
      for (SeenPoint& p : moved) p.x -= beside * offset[k][0], p.y -= beside * offset[k][1];
      lines[k].add_triangle(moved, sense);
    }
    return 1.0;
  });
  return std::min({lines[0].inside(), lines[1].inside(), lines[2].inside()});
}

/// As ContactSurface::is_inside, also beside a closed slit: a point behind one wall may be nearest to the front of the
/// other. Tissue ends where a line leaves it: behind the nearest wall, the line from the point passes through the other
/// one from the inside. `reach` [m]: of the walls into each other, less than the thickness of the tissue.
inline bool is_behind(const ContactSurface& surface, const Vector3& p, double reach) noexcept {
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

/// For an open surface.
inline double length_behind(const ContactSurface& surface, const Vector3& a, const Vector3& b, double reach) noexcept {
  constexpr int intervals = 8;   // along the edge
  constexpr int bisections = 7;  // of an interval in which the edge leaves the tissue
  const auto is_inside = [&](double part) { return is_behind(surface, a + part * (b - a), reach); };
  double inside = 0.0;
  int left = 4;  // ends that are found by bisection; at others half of the interval counts
  bool before = is_inside(0.0);
  for (int k = 1; k <= intervals; ++k) {
    const double start = (k - 1.0) / intervals;
    const bool now = is_inside(static_cast<double>(k) / intervals);
    if (before && now) inside += 1.0 / intervals;
    if (before != now) {
      double from = 0.0, to = 1.0;  // of the interval; `from` is as its start
      for (int i = 0; i < bisections && left > 0; ++i) {
        const double middle = 0.5 * (from + to);
        (is_inside(start + middle / intervals) == before ? from : to) = middle;
      }
      --left;
      const double part = 0.5 * (from + to);
      inside += (before ? part : 1.0 - part) / intervals;
    }
    before = now;
  }
  return (b - a).norm() * inside;
}

/// Length of the part of the edge from a to b that is in tissue [m]; frame of the surface. Every crossing of a line
/// with a closed boundary enters or leaves tissue, and tissue is where more were entered than left. So two walls of a
/// closed slit cancel, rounding moves the ends of the parts by no more than itself, and tissue that is pressed into
/// tissue counts once. If the edge crosses the boundary more than 64 times, overlapping tissue counts once per layer.
/// An edge with an end that is not finite has no length. Beside an open surface: the part of the edge that is behind
/// the surface, found between 9 points of the edge by bisection; `reach` [m] is how far the walls of a slit may be
/// pressed into each other. O(log triangles + triangles near the line).
inline double length_in_tissue(const ContactSurface& surface, const Vector3& a, const Vector3& b,
                               double reach) noexcept {
  if (!((b - a).squaredNorm() < infinity)) return 0.0;  // also if an end is not a number
  return surface.is_closed() ? length_inside(surface.boundary(), a, b) : length_behind(surface, a, b, reach);
}

}}}  // namespace palpate::detail
