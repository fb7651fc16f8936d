// Definitions of sphere_tool.hpp.
#pragma once

#include <palpate/contact/sphere_tool.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void SphereTool::require_valid() const {
  if (!(std::isfinite(radius) && radius > 0.0))
    raise(SetupErrorKind::bad_argument, "the radius of a sphere tool is " + number(radius),
          "It must be finite and positive, in metres");
}

}}  // namespace palpate
