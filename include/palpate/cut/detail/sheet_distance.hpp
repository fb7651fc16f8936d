// Distance from the sheet that a blade has swept.
#pragma once

#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Signed distance from the surface swept by a blade, continued beyond its edges.
class SheetDistance {
 public:
  explicit SheetDistance(const BladeSweep& sweep) noexcept : origin_(sweep.a0) {
    const Vector3 diagonal = sweep.b1 - sweep.a0;
    const Vector3 first = cross(sweep.b0 - sweep.a0, diagonal);
    Vector3 second = cross(diagonal, sweep.a1 - sweep.a0);
    if (first.dot(second) < 0.0) second = -second;  // a blade that turns about its middle
    const Vector3 both = first + second;
    beside_ = cross(both, diagonal);
    normal_ = {unit(first, both), unit(second, both)};
  }
  /// Of the triangle on whose side of the diagonal x is.
  const Vector3& normal_at(const Vector3& x) const noexcept {
    return normal_[(x - origin_).dot(beside_) > 0.0 ? 1 : 0];
  }
  double operator()(const Vector3& x) const noexcept { return (x - origin_).dot(normal_at(x)); }

 private:
  /// That of both triangles for one without area.
  static Vector3 unit(const Vector3& normal, const Vector3& both) noexcept {
    constexpr double rounding = 1e-9;
    const Vector3& used = normal.norm() > rounding * both.norm() ? normal : both;
    return used / used.norm();
  }

  Vector3 origin_, beside_;
  std::array<Vector3, 2> normal_;
};

}}}  // namespace palpate::detail
