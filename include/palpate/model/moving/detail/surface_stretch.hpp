// How the half-space below a stretched surface yields.
#pragma once

#include <palpate/contact/detail/triangle.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// For the displacement of contact points that the mesh does not show (SubfacetCompliance), at large strain. That of an
/// unstretched half-space at rest is u = G f. A tool that presses deep stretches the surface, by lambda in both
/// directions. Then distances are larger, and a neo-Hookean half-space is stiffer by
/// (lambda^9 + lambda^6 + 3 lambda^3 - 1) / (2 lambda^4 (lambda^3 + 1)) (Green, Rivlin and Shield 1952; its zero is
/// Biot's wrinkling at lambda = 0.666). Along the surface it is made stiffer by lambda^4 more, which is not from
/// theory: points between vertices else slide off a tool that presses by more than 0.9 of its radius. At small strain
/// all of this is 1. The displacement becomes M_p G M_q^T f, with a map M per vertex.
class SurfaceStretch {
 public:
  SurfaceStretch() = default;
  /// `rest`: positions of the vertices. Allocates.
  SurfaceStretch(const std::vector<Vector3>& rest, std::vector<Triangle> triangles);

  /// Sets the map of every vertex, for vertices at `positions` whose surroundings are rotated by `rotation`. Stretches
  /// count from 1 to 3: compression changes nothing. O(triangles), no allocation.
  void find(const std::vector<Vector3>& positions, const std::vector<Matrix3>& rotation,
            std::vector<Matrix3>& map) noexcept;

  /// The part of the displacement along the normal that is left at a stretch; decreases, 1 at 1.
  static double softness(double stretch) noexcept {
    const double cube = stretch * stretch * stretch;
    const double stiffer =
        (cube * cube * cube + cube * cube + 3.0 * cube - 1.0) / (2.0 * stretch * cube * (cube + 1.0));
    return 1.0 / (stretch * stiffer);
  }

 private:
  std::vector<Triangle> triangles_;
  std::vector<Vector3> normal_;      // of every vertex at rest, unit
  std::vector<double> rest_, area_;  // of the triangles around it, at rest and now, twice [m^2]
};

/// Twice the area of a triangle along its normal.
inline Vector3 area_vector(const std::vector<Vector3>& x, const Triangle& t) noexcept {
  const Vector3& first = x[static_cast<std::size_t>(t[0])];
  return (x[static_cast<std::size_t>(t[1])] - first).cross(x[static_cast<std::size_t>(t[2])] - first);
}

inline SurfaceStretch::SurfaceStretch(const std::vector<Vector3>& rest, std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)),
      normal_(rest.size(), Vector3(0.0, 0.0, 0.0)),
      rest_(rest.size(), 0.0),
      area_(rest.size(), 0.0) {
  for (const Triangle& t : triangles_)
    for (const int v : t) {
      normal_[static_cast<std::size_t>(v)] += area_vector(rest, t);
      rest_[static_cast<std::size_t>(v)] += area_vector(rest, t).norm();
    }
  for (Vector3& n : normal_) n.normalize();
}

inline void SurfaceStretch::find(const std::vector<Vector3>& positions, const std::vector<Matrix3>& rotation,
                                 std::vector<Matrix3>& map) noexcept {
  constexpr double largest = 3.0;
  std::fill(area_.begin(), area_.end(), 0.0);
  for (const Triangle& t : triangles_) {
    const double area = area_vector(positions, t).norm();
    for (const int v : t) area_[static_cast<std::size_t>(v)] += area;
  }
  for (std::size_t i = 0; i < area_.size(); ++i) {
    const double stretch = rest_[i] > 0.0 ? std::clamp(std::sqrt(area_[i] / rest_[i]), 1.0, largest) : 1.0;
    const double normal = std::sqrt(softness(stretch)), tangential = normal / (stretch * stretch);
    map[i] = tangential * rotation[i] + (normal - tangential) * ((rotation[i] * normal_[i]) * normal_[i].transpose());
  }
}

}}}  // namespace palpate::detail
