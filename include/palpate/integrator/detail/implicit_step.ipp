// Definitions of implicit_step.hpp.
#pragma once

#include <palpate/integrator/detail/implicit_step.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ImplicitStep::ImplicitStep(const TimeScheme& scheme, Index size)
    : scheme_(scheme), predicted_(size), coasting_(size) {
  for (const double c : {scheme.new_in_u, scheme.new_in_v})
    if (!(c > 0.0)) raise(SetupErrorKind::bad_argument, "the time scheme is explicit", "Use central differences");
}

PALPATE_INLINE void ImplicitStep::coast(const VectorX& u, const VectorX& v, const VectorX& a) noexcept {
  predicted_ = u + h_ * v + (scheme_.old_in_u * h_ * h_) * a;
  coasting_ = v + (scheme_.old_in_v * h_) * a;
}

PALPATE_INLINE void ImplicitStep::find_motion(const VectorX& end, VectorX& velocity,
                                              VectorX& acceleration) const noexcept {
  acceleration = acceleration_per_displacement() * (end - predicted_);
  velocity = coasting_ + (scheme_.new_in_v * h_) * acceleration;
}

PALPATE_INLINE double ImplicitStep::potential(const VectorX& velocity, const VectorX& damping_force,
                                              const VectorX& acceleration, const VectorX& inertia) const noexcept {
  return 0.5 / velocity_per_displacement() * velocity.dot(damping_force) +
         0.5 / acceleration_per_displacement() * acceleration.dot(inertia);
}

}}  // namespace palpate
