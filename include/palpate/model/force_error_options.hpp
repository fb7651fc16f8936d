// Whether the error of contact forces is measured at set-up.
#pragma once

#include <palpate/core/config.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

class ForceAccuracy;
class TissueView;
namespace detail {

struct ForceErrorSource;

}  // namespace detail
struct MeshRef;
struct SetupLimits;
struct SetupReport;

/// Measures errors and enters them in the report; null when it was not possible.
using MeasureForceError = std::shared_ptr<const ForceAccuracy> (*)(const detail::ForceErrorSource&, const TissueView&,
                                                                   const SetupLimits&, SetupReport&);

/// By default nothing is measured and nothing is compiled. `measured_force_error()` of
/// model/static/measured_force_error.hpp is the option that measures.
struct ForceErrorOptions {
  int places = 0;                       ///< of the touchable surface where a sphere is pressed
  MeasureForceError measure = nullptr;  ///< null: nothing is measured
  /// The tetrahedra that refine_near refined to the mesh of the model: the reference is then made from them, with fewer
  /// nodes. Null: from the mesh of the model. Must live during the set-up.
  const MeshRef* coarse = nullptr;
  /// Error that is wanted, relative to the force: above it, and when nothing could be measured,
  /// SetupFlag::accuracy_not_reached is set. 0: any. Nothing is refined: see refine_to_accuracy.
  double wanted = 0.0;
};

}}  // namespace palpate
