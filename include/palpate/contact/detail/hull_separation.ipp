// Definitions of hull_separation.hpp.
#pragma once

#include <palpate/contact/detail/hull_separation.hpp>
#include <palpate/core/detail/small_matrix.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

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

}  // namespace detail

PALPATE_INLINE Separation separate(std::span<const Vector3> points, const std::array<Vector3, 3>& corner) noexcept {
  detail::Simplex simplex;
  Separation best;
  Vector3 v = simplex.add(points.front() - corner[0]);
  for (int round = 0; round < 32; ++round) {
    const double length = v.norm();
    if (simplex.contains_origin() || !(length > 0.0)) return {};
    const Vector3 w = detail::lowest(points, v) - detail::lowest(corner, -v);
    const double least = v.dot(w) / length;
    if (least > best.distance) best = {v / length, least};
    if (length - least <= 1e-12 * length) break;
    v = simplex.add(w);
    if (!(v.norm() < length)) break;  // rounding: no closer any more
  }
  return best;
}

}}  // namespace palpate
