// A tool with a sharp edge.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A sharp edge with its middle at the tool's position. Its direction is fixed in the world: it does not rotate with
/// the device. It cuts the surface that it sweeps, in any direction across itself; motion along itself, and in a slit
/// that it has cut, has no resistance. For a tissue that can be cut (TissueModel: try_cut).
struct BladeTool {
  Vector3 edge{0.0, 0.01, 0.0};  ///< from one end of the edge to the other [m]
  double toughness = 100.0;      ///< work per area of new slit [J/m^2]; about 50 to 500 for soft tissues
  double cut_spacing = 1e-3;     ///< path of the edge between two cut requests [m]

  /// Throws bad_argument for an edge of zero length, a cut spacing that is not positive, a toughness below zero, and
  /// values that are not finite.
  void require_valid() const;
};

inline void BladeTool::require_valid() const {
  for (const double value : {edge.norm(), cut_spacing})
    if (!(value > 0.0 && value < infinity))
      raise(SetupErrorKind::bad_argument, "the edge or cut spacing of a blade is " + number(value),
            "Give positive SI values");
  if (!(toughness >= 0.0 && toughness < infinity))
    raise(SetupErrorKind::bad_argument, "the toughness is " + number(toughness), "Give zero or more, in J/m^2");
}

}}  // namespace palpate
