// Nearest point of a set of points, segments, triangles and tetrahedra.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The convex hull of one to four points.
struct SimplexCorners {
  std::array<Vector3, 4> corners;
  int count = 1;
};

/// Finds the closest of many simplices with a tree of boxes.
class SimplexTree {
 public:
  struct Nearest {
    Vector3 point = Vector3::Zero();
    double distance = infinity;  ///< infinite without simplices
  };

  SimplexTree() = default;
  /// O(n log n), allocates.
  explicit SimplexTree(std::vector<SimplexCorners> simplices) : simplices_(std::move(simplices)) {
    if (simplices_.empty()) return;
    nodes_.emplace_back();
    divide(0, 0, static_cast<int>(simplices_.size()));
  }

  bool empty() const noexcept { return simplices_.empty(); }
  const Box& box() const noexcept { return nodes_.front().box; }

  /// The nearest point within `reach` [m]; an infinite distance if there is none. No allocation.
  Nearest nearest(const Vector3& p, double reach = infinity) const noexcept;

 private:
  struct Node {
    Box box;
    int first = 0, count = 0;  ///< simplices; children of an inner node are `first`, `first` + 1 and count is 0
  };

  void divide(std::size_t node, int first, int count);
  void visit(std::size_t node, const Vector3& p, Nearest& best, double& square) const noexcept;

  std::vector<SimplexCorners> simplices_;
  std::vector<Node> nodes_;
};

inline Box simplex_box(const SimplexCorners& s) noexcept {
  Box box;
  for (int i = 0; i < s.count; ++i) box.include(s.corners[static_cast<std::size_t>(i)]);
  return box;
}

inline Vector3 closest_of_segment(const Vector3& a, const Vector3& b, const Vector3& p) noexcept {
  const Vector3 along = b - a;
  const double square = along.squaredNorm(), t = (p - a).dot(along);
  if (!(square > 0.0) || t <= 0.0) return a;
  return t >= square ? b : Vector3(a + t / square * along);
}

/// Inside the triangle the foot of the perpendicular, else the closest of its edges' points.
inline Vector3 closest_of_triangle(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& p) noexcept {
  const Vector3 normal = cross(b - a, c - a);
  const double square = normal.squaredNorm();
  if (square > 0.0 && cross(b - a, p - a).dot(normal) >= 0.0 && cross(c - b, p - b).dot(normal) >= 0.0 &&
      cross(a - c, p - c).dot(normal) >= 0.0)
    return p - (p - a).dot(normal) / square * normal;
  Vector3 best = closest_of_segment(a, b, p);
  for (const Vector3& other : {closest_of_segment(b, c, p), closest_of_segment(c, a, p)})
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  return best;
}

inline Vector3 closest_of_tetrahedron(const std::array<Vector3, 4>& x, const Vector3& p) noexcept {
  constexpr std::array<std::array<std::size_t, 4>, 4> faces{{{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
  const bool is_inside = std::ranges::all_of(faces, [&](const auto& face) {
    const auto& [i, j, k, opposite] = face;
    const Vector3 normal = cross(x[j] - x[i], x[k] - x[i]);
    return (x[opposite] - x[i]).dot(normal) * (p - x[i]).dot(normal) > 0.0;
  });
  if (is_inside) return p;
  Vector3 best = x[0];
  for (const auto& [i, j, k, opposite] : faces)
    if (const Vector3 other = closest_of_triangle(x[i], x[j], x[k], p);
        (other - p).squaredNorm() < (best - p).squaredNorm())
      best = other;
  return best;
}

/// The point of a simplex closest to p. Corners may coincide or be in one plane.
inline Vector3 closest_in_simplex(const SimplexCorners& simplex, const Vector3& p) noexcept {
  const auto& x = simplex.corners;
  switch (simplex.count) {
    case 1:
      return x[0];
    case 2:
      return closest_of_segment(x[0], x[1], p);
    case 3:
      return closest_of_triangle(x[0], x[1], x[2], p);
    default:
      return closest_of_tetrahedron(x, p);
  }
}

inline void SimplexTree::divide(std::size_t node, int first, int count) {
  constexpr int leaf = 4;
  Box box;
  for (int i = first; i < first + count; ++i) box.include(simplex_box(simplices_[static_cast<std::size_t>(i)]));
  nodes_[node] = {box, first, count};
  if (count <= leaf) return;
  int axis = 0;
  box.size().maxCoeff(&axis);
  const auto begin = simplices_.begin() + first, middle = begin + count / 2;
  std::nth_element(begin, middle, begin + count, [axis](const SimplexCorners& a, const SimplexCorners& b) {
    const Box one = simplex_box(a), other = simplex_box(b);
    return one.low[axis] + one.high[axis] < other.low[axis] + other.high[axis];
  });
  const std::size_t child = nodes_.size();
  nodes_[node].first = static_cast<int>(child);
  nodes_[node].count = 0;
  nodes_.resize(child + 2);
  divide(child, first, count / 2);
  divide(child + 1, first + count / 2, count - count / 2);
}

inline void SimplexTree::visit(std::size_t node, const Vector3& p, Nearest& best, double& square) const noexcept {
  const Node& n = nodes_[node];
  for (int i = n.first; i < n.first + n.count; ++i) {
    const Vector3 point = closest_in_simplex(simplices_[static_cast<std::size_t>(i)], p);
    if (const double d = (point - p).squaredNorm(); d <= square) {
      square = d;
      best = {point, std::sqrt(d)};
    }
  }
  if (n.count > 0 || square == 0.0) return;
  auto first = static_cast<std::size_t>(n.first), second = first + 1;
  double to_first = nodes_[first].box.squared_distance(p), to_second = nodes_[second].box.squared_distance(p);
  if (to_second < to_first) {
    std::swap(first, second);
    std::swap(to_first, to_second);
  }
  if (to_first <= square) visit(first, p, best, square);
  if (to_second <= square && square > 0.0) visit(second, p, best, square);
}

inline SimplexTree::Nearest SimplexTree::nearest(const Vector3& p, double reach) const noexcept {
  Nearest best;
  double square = reach * reach;
  if (!empty()) visit(0, p, best, square);
  return best;
}

}}}  // namespace palpate::detail
