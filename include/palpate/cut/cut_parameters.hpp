// Parameters and reports of a model that can be cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/scene.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// Parameters of a model on Cuttable<...>.
struct CutParameters {
  /// Group, region, nodes or set of points whose compliance is stored in addition to that of the touchable ones: cuts
  /// there need no solve.
  std::optional<Selection> cuttable{};
  /// Blades cut Tet4 where they pass: nodes beside the sheet are moved onto it at rest, and edges divided; that changes
  /// more rows. Otherwise, and for other elements, cuts follow the faces nearest to the sheet.
  bool straight = false;
  Index most_added = 900;          ///< dofs that cuts may add before a new factor is made in a background thread
  double tolerated_error = 1e-10;  ///< relative, as measured; beyond it a new factor is made immediately
};

/// Statistics and cost of the cuts.
struct CutReport {
  std::uint64_t cuts = 0;      ///< number of cuts that changed something
  std::uint64_t changes = 0;   ///< of the body's topology: cuts and resets
  std::uint64_t renewals = 0;  ///< new factors
  Index rank = 0;              ///< rows that the last cut changed
  Index kept = 0;              ///< dofs with a compliance
  double smallest = 1.0;       ///< CutStep::smallest of the last cut
  double error = 0.0;          ///< of the compliance, as last measured, relative
  int unchecked = 0;           ///< cuts since that measurement
  double latency = 0.0;        ///< of the last cut, from taking the order to passing the surface to the tick [s]
  double fold_seconds = 0.0;   ///< of the last cut, until the tick had no correction left to add [s]
  /// Largest displacement of a touchable vertex by the scene's loads, against their mean, relative to the body's
  /// diagonal. Above 0.1 ticks report large_displacement: usually a remnant that hangs on a few faces.
  double displacement = 0.0;
  double off_sheet = 0.0;  ///< of the last cut: farthest node of its walls from the sheet of the blade [m]
  double quality = 1.0;    ///< least quality (ElementShape) of the elements that cuts have changed
  bool failed = false;     ///< remaining body cannot be computed; the last good state is rendered, degraded_model
};

}}  // namespace palpate
