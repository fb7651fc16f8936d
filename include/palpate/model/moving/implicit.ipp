// Definitions of implicit.hpp.
#pragma once

#include <palpate/model/moving/implicit.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ImplicitMotion::ImplicitMotion(DeformableBody body, const DynamicsParameters& parameters,
                                              const SetupLimits& limits)
    : motion_(std::move(body), parameters, limits) {}

PALPATE_INLINE MotionStep ImplicitMotion::step(double h) noexcept {
  const StepReport done = motion_.step(h);
  MotionStep step{done.taken, {}, done.deformation};
  if (done.deformation.inverted > 0) step.status.set(StatusFlag::inverted);
  if (done.deformation.beyond_range > 0) step.status.set(StatusFlag::material_exceeded);
  const bool accurate = done.newton.converged || done.newton.relative_residual <= tolerable_residual;
  if (!done.taken || !done.energy_bounded || !accurate) step.status.set(StatusFlag::solver_not_converged);
  return step;
}
PALPATE_INLINE bool ImplicitMotion::correct(const VectorX& more) noexcept {
  return motion_.correct(more);
}
PALPATE_INLINE bool ImplicitMotion::set_springs(std::span<const ContactSpring> springs) noexcept {
  motion_.set_springs(springs);
  return true;
}
PALPATE_INLINE bool ImplicitMotion::prepare_response(double h) noexcept {
  return motion_.prepare_response(h);
}
PALPATE_INLINE bool ImplicitMotion::respond(const VectorX& forces, VectorX& u) noexcept {
  return motion_.respond(forces, u);
}
PALPATE_INLINE bool ImplicitMotion::respond_here(const VectorX& forces, VectorX& u) noexcept {
  return motion_.is_factorised() && motion_.respond(forces, u);
}
PALPATE_INLINE const VectorX& ImplicitMotion::displacement() const noexcept {
  return motion_.displacement();
}
PALPATE_INLINE const VectorX& ImplicitMotion::velocity() const noexcept {
  return motion_.velocity();
}
PALPATE_INLINE void ImplicitMotion::rest_at(const VectorX& u) {
  motion_.rest_at(u);
}
PALPATE_INLINE void ImplicitMotion::set_load(const VectorX& load) {
  motion_.set_load(load);
}
PALPATE_INLINE void ImplicitMotion::set_prescribed(const VectorX& values) {
  motion_.set_prescribed(values);
}

}}  // namespace palpate
