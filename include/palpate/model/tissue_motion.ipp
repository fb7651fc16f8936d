// Definitions of tissue_motion.hpp.
#pragma once

#include <palpate/model/tissue_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/diagnosis.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE VectorX settled(Equilibrium& statics) {
  const EquilibriumReport report = statics.solve();
  if (!report.converged)
    raise(SetupErrorKind::not_converged, describe(report), "Set settle = false, or hold it better");
  return statics.displacement();
}

}}}  // namespace palpate::detail
