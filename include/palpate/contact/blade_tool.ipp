// Definitions of blade_tool.hpp.
#pragma once

#include <palpate/contact/blade_tool.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void BladeTool::require_valid() const {
  for (const double value : {edge.norm(), cut_spacing})
    if (!(value > 0.0 && value < infinity))
      raise(SetupErrorKind::bad_argument, "the edge or cut spacing of a blade is " + number(value),
            "Give positive SI values");
  if (!(toughness >= 0.0 && toughness < infinity))
    raise(SetupErrorKind::bad_argument, "the toughness is " + number(toughness), "Give zero or more, in J/m^2");
}

}}  // namespace palpate
