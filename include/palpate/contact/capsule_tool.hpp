// A tool with a round cross-section and round ends.
#pragma once

#include <palpate/contact/sphere_tool.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// A rigid capsule: all points within `radius` of a segment of its axis, from `-half_length` to `half_length` about the
/// tool's position. This is the cylinder of the thesis, with round ends. It rotates with the device; with zero length
/// it is a sphere.
struct CapsuleTool {
  double radius = 4e-3;         ///< [m]
  double half_length = 0.0;     ///< [m]
  Vector3 axis{0.0, 0.0, 1.0};  ///< in the tool's own frame, any length but zero

  CapsuleTool() = default;
  CapsuleTool(const SphereTool& sphere) : radius(sphere.radius) {}  // NOLINT(google-explicit-constructor)
  CapsuleTool(double r, double half, const Vector3& direction = {0.0, 0.0, 1.0})
      : radius(r), half_length(half), axis(direction) {}

  /// Throws bad_argument when the radius is not finite and positive, the axis has zero length, or the capsule is longer
  /// than 32 radii: more contact points than the capacity would be under it.
  void require_valid() const;
};

inline void CapsuleTool::require_valid() const {
  SphereTool{radius}.require_valid();
  if (!(half_length >= 0.0 && half_length <= 16.0 * radius))
    raise(SetupErrorKind::bad_argument, "half the length of a capsule tool is " + number(half_length),
          "Give 0 to 16 radii, in metres");
  if (half_length > 0.0 && !(axis.norm() > 0.0 && std::isfinite(axis.norm())))
    raise(SetupErrorKind::bad_argument, "the axis of a capsule tool has no direction");
}

}}  // namespace palpate
