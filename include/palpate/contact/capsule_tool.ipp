// Definitions of capsule_tool.hpp.
#pragma once

#include <palpate/contact/capsule_tool.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void CapsuleTool::require_valid() const {
  SphereTool{radius}.require_valid();
  if (!(half_length >= 0.0 && half_length <= 16.0 * radius))
    raise(SetupErrorKind::bad_argument, "half the length of a capsule tool is " + number(half_length),
          "Give 0 to 16 radii, in metres");
  if (half_length > 0.0 && !(axis.norm() > 0.0 && std::isfinite(axis.norm())))
    raise(SetupErrorKind::bad_argument, "the axis of a capsule tool has no direction");
}

}}  // namespace palpate
