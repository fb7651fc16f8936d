// What a model that is cut may choose, and what it reports of its cuts.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/scene.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

/// What a model on Cuttable<...> may choose.
struct CutParameters {
  /// Group, region, nodes or set of points whose compliance is kept ready beside that of the touchable ones: cuts there
  /// need no solve.
  std::optional<Selection> cuttable{};
  Index most_added = 900;          ///< dofs that cuts may add before a new factor is made, in a thread of its own
  double tolerated_error = 1e-10;  ///< measured, relative; beyond it a new factor is made at once
};

/// What cutting has cost.
struct CutReport {
  std::uint64_t cuts = 0;      ///< that changed something
  std::uint64_t changes = 0;   ///< of the body's topology: cuts, and being made whole again
  std::uint64_t renewals = 0;  ///< new factors
  Index rank = 0;              ///< rows that the last cut changed
  Index kept = 0;              ///< dofs with a compliance
  double smallest = 1.0;       ///< CutStep::smallest of the last cut
  double error = 0.0;          ///< of the compliance, as last measured, relative
  int unchecked = 0;           ///< cuts since that
  double latency = 0.0;        ///< of the last cut: from taking the order to handing the surface to the tick
  double fold_seconds = 0.0;   ///< of the last cut: until nothing was left to add up in the tick
  bool failed = false;         ///< what is left cannot be computed; the last good state is felt, degraded_model
};

}}  // namespace palpate
