// Definitions of surface_stretch.hpp.
#pragma once

#include <palpate/model/moving/detail/surface_stretch.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Twice the area of a triangle along its normal.
inline Vector3 area_vector(const std::vector<Vector3>& x, const Triangle& t) noexcept {
  const Vector3& first = x[static_cast<std::size_t>(t[0])];
  return (x[static_cast<std::size_t>(t[1])] - first).cross(x[static_cast<std::size_t>(t[2])] - first);
}

}  // namespace detail

PALPATE_INLINE SurfaceStretch::SurfaceStretch(const std::vector<Vector3>& rest, std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)),
      normal_(rest.size(), Vector3(0.0, 0.0, 0.0)),
      rest_(rest.size(), 0.0),
      area_(rest.size(), 0.0) {
  for (const Triangle& t : triangles_)
    for (const int v : t) {
      normal_[static_cast<std::size_t>(v)] += detail::area_vector(rest, t);
      rest_[static_cast<std::size_t>(v)] += detail::area_vector(rest, t).norm();
    }
  for (Vector3& n : normal_) n.normalize();
}

PALPATE_INLINE double SurfaceStretch::softness(double stretch) noexcept {
  const double cube = stretch * stretch * stretch;
  const double stiffer = (cube * cube * cube + cube * cube + 3.0 * cube - 1.0) / (2.0 * stretch * cube * (cube + 1.0));
  return 1.0 / (stretch * stiffer);
}

PALPATE_INLINE void SurfaceStretch::find(const std::vector<Vector3>& positions, const std::vector<Matrix3>& rotation,
                                         std::vector<Matrix3>& map) noexcept {
  constexpr double largest = 3.0;
  std::fill(area_.begin(), area_.end(), 0.0);
  for (const Triangle& t : triangles_) {
    const double area = detail::area_vector(positions, t).norm();
    for (const int v : t) area_[static_cast<std::size_t>(v)] += area;
  }
  for (std::size_t i = 0; i < area_.size(); ++i) {
    const double stretch = rest_[i] > 0.0 ? std::clamp(std::sqrt(area_[i] / rest_[i]), 1.0, largest) : 1.0;
    const double normal = std::sqrt(softness(stretch)), tangential = normal / (stretch * stretch);
    map[i] = tangential * rotation[i] + (normal - tangential) * ((rotation[i] * normal_[i]) * normal_[i].transpose());
  }
}

}}  // namespace palpate
