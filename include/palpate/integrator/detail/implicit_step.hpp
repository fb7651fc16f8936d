// One step of an implicit scheme: from the displacement at its end to the motion there.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/time_scheme.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What a TimeScheme makes of a length h and a state: where the motion coasts to without new acceleration, and velocity
/// and acceleration at the end as functions of the displacement there. Vectors have one entry per dof. Allocates when
/// it is made only.
class ImplicitStep {
 public:
  /// Throws bad_argument for a scheme in which the new acceleration does not count: that one is explicit.
  ImplicitStep(const TimeScheme& scheme, Index size);

  static bool is_length(double h) noexcept { return h > 0.0 && h < infinity; }
  void set_length(double h) noexcept { h_ = h; }
  double length() const noexcept { return h_; }  ///< [s]; 0 before the first
  /// d a / d u at the end [1/s^2], and d v / d u [1/s].
  double acceleration_per_displacement() const noexcept { return 1.0 / (scheme_.new_in_u * h_ * h_); }
  double velocity_per_displacement() const noexcept { return scheme_.new_in_v / (scheme_.new_in_u * h_); }

  void coast(const VectorX& u, const VectorX& v, const VectorX& a) noexcept;
  const VectorX& predicted() const noexcept { return predicted_; }  ///< where it coasts to [m]
  void find_motion(const VectorX& end, VectorX& velocity, VectorX& acceleration) const noexcept;
  /// What inertia M a and damping D v at the end add to the potential of the step [J].
  double potential(const VectorX& velocity, const VectorX& damping_force, const VectorX& acceleration,
                   const VectorX& inertia) const noexcept;

 private:
  TimeScheme scheme_;
  VectorX predicted_, coasting_;
  double h_ = 0.0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/integrator/detail/implicit_step.ipp>
#endif
