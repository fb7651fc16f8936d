// A tool with a sharp edge.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A sharp edge, its middle at the tool's position. It keeps its directions in the world: it does not turn with the
/// device. For a tissue that can be cut (TissueModel: try_cut).
struct BladeTool {
  Vector3 edge{0.0, 0.01, 0.0};     ///< from one end of the edge to the other [m]
  Vector3 forward{0.0, 0.0, -1.0};  ///< where it is sharp; the blade goes back without resistance
  double toughness = 100.0;         ///< work per area of new slit [J/m^2]; soft tissues have some 50 to 500
  double cut_spacing = 1e-3;        ///< path of the edge from one cut order to the next [m]

  /// Throws bad_argument for an edge or forward direction without length, an edge along it, a stroke that is not
  /// positive or a toughness below zero, and what is not finite.
  void require_valid() const;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/blade_tool.ipp>
#endif
