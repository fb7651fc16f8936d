// Definitions of linear_forces.hpp.
#pragma once

#include <palpate/assembly/detail/linear_forces.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(ForceOperator<LinearForces>);

PALPATE_INLINE double LinearForces::energy(const VectorX& u) const noexcept {
  stiffness_.apply(u, force_);
  return 0.5 * u.dot(force_);
}

PALPATE_INLINE DeformationReport LinearForces::force(const VectorX& u, VectorX& f) const noexcept {
  stiffness_.apply(u, f);
  DeformationReport report;
  report.smallest_volume_ratio = 1.0;
  return report;
}

}}  // namespace palpate
