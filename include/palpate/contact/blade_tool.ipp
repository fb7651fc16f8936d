// Definitions of blade_tool.hpp.
#pragma once

#include <palpate/contact/blade_tool.hpp>
#include <palpate/core/detail/small_matrix.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void BladeTool::require_valid() const {
  const double length = edge.norm(), sharp = forward.norm();
  for (const double value : {length, sharp, cut_spacing})
    if (!(value > 0.0 && value < infinity))
      raise(SetupErrorKind::bad_argument, "the edge, forward direction or cut spacing of a blade is " + number(value),
            "Give positive SI values");
  if (!(cross(edge, forward).norm() > 1e-3 * length * sharp))
    raise(SetupErrorKind::bad_argument, "the edge of a blade is parallel to its forward direction",
          "Give an edge at an angle to it: the cut is the area that the edge sweeps");
  if (!(toughness >= 0.0 && toughness < infinity))
    raise(SetupErrorKind::bad_argument, "the toughness is " + number(toughness), "Give zero or more, in J/m^2");
}

}}  // namespace palpate
