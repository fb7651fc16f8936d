// What the edge of a blade sweeps.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What the edge of a blade sweeps between two places: the quadrilateral from edge (a0, b0) to edge (a1, b1) [m], as
/// two triangles. The frame is that of the positions it is asked about.
struct BladeSweep {
  Vector3 a0 = Vector3::Zero(), b0 = Vector3::Zero(), a1 = Vector3::Zero(), b1 = Vector3::Zero();

  /// [m^2]
  double area() const noexcept;
  Box box() const noexcept;
  /// Whether the way from p to q crosses it. A point on the sheet counts as on its front side, and a way through the
  /// sheet's edge as a crossing: what lies on two sides of a closed sheet is never left connected.
  bool crosses(const Vector3& p, const Vector3& q) const noexcept;

 private:
  static double volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept;
  static bool crosses_triangle(const Vector3& p, const Vector3& q, const Vector3& x, const Vector3& y,
                               const Vector3& z) noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/blade_sweep.ipp>
#endif
