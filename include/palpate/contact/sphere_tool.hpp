// A spherical tool tip.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// A rigid sphere at the tool's position.
struct SphereTool {
  double radius = 4e-3;  ///< [m]

  /// Throws bad_argument when the radius is not finite and positive.
  void require_valid() const;
};

inline void SphereTool::require_valid() const {
  if (!(std::isfinite(radius) && radius > 0.0))
    raise(SetupErrorKind::bad_argument, "the radius of a sphere tool is " + number(radius),
          "It must be finite and positive, in metres");
}

}}  // namespace palpate
