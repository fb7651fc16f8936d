// One-step schemes for second-order equations of motion, and one step of them.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// u' = u + h v + h^2 (p a + q a'),  v' = v + h (r a + s a'), with a' the acceleration at the end of the step.
struct TimeScheme {
  double old_in_u = 0.0, new_in_u = 1.0;  ///< p, q
  double old_in_v = 0.0, new_in_v = 1.0;  ///< r, s

  /// First order, dissipative: amplitude 1 / sqrt(1 + (w h)^2) per step of an oscillation w. Never adds energy to a
  /// body with a convex energy.
  static constexpr TimeScheme implicit_euler() noexcept { return {}; }
  /// Newmark 1959. Second order without damping for beta = 1/4, gamma = 1/2 (trapezoidal rule); gamma > 1/2 damps.
  static constexpr TimeScheme newmark(double beta = 0.25, double gamma = 0.5) noexcept {
    return {0.5 - beta, beta, 1.0 - gamma, gamma};
  }
};

namespace detail {

/// Evaluates a TimeScheme for a step length h and a state: the predicted displacement without new acceleration, and
/// velocity and acceleration at the end as functions of the displacement there. Vectors have one entry per dof. Only
/// the constructor allocates.
class ImplicitStep {
 public:
  /// Throws bad_argument for a scheme that does not use the new acceleration: that scheme is explicit.
  ImplicitStep(const TimeScheme& scheme, Index size);

  static bool is_length(double h) noexcept { return h > 0.0 && h < infinity; }
  void set_length(double h) noexcept { h_ = h; }
  double length() const noexcept { return h_; }  ///< [s]; 0 before the first step
  /// d a / d u at the end of the step [1/s^2], and d v / d u [1/s].
  double acceleration_per_displacement() const noexcept { return 1.0 / (scheme_.new_in_u * h_ * h_); }
  double velocity_per_displacement() const noexcept { return scheme_.new_in_v / (scheme_.new_in_u * h_); }

  void coast(const VectorX& u, const VectorX& v, const VectorX& a) noexcept;
  const VectorX& predicted() const noexcept { return predicted_; }  ///< displacement without new acceleration [m]
  void find_motion(const VectorX& end, VectorX& velocity, VectorX& acceleration) const noexcept;
  /// Contribution of inertia M a and damping D v at the end of the step to its potential [J].
  double potential(const VectorX& velocity, const VectorX& damping_force, const VectorX& acceleration,
                   const VectorX& inertia) const noexcept;

 private:
  TimeScheme scheme_;
  VectorX predicted_, coasting_;
  double h_ = 0.0;
};

inline ImplicitStep::ImplicitStep(const TimeScheme& scheme, Index size)
    : scheme_(scheme), predicted_(size), coasting_(size) {
  for (const double c : {scheme.new_in_u, scheme.new_in_v})
    if (!(c > 0.0)) raise(SetupErrorKind::bad_argument, "the time scheme is explicit", "Use central differences");
}

inline void ImplicitStep::coast(const VectorX& u, const VectorX& v, const VectorX& a) noexcept {
  predicted_ = u + h_ * v + (scheme_.old_in_u * h_ * h_) * a;
  coasting_ = v + (scheme_.old_in_v * h_) * a;
}

inline void ImplicitStep::find_motion(const VectorX& end, VectorX& velocity, VectorX& acceleration) const noexcept {
  acceleration = acceleration_per_displacement() * (end - predicted_);
  velocity = coasting_ + (scheme_.new_in_v * h_) * acceleration;
}

inline double ImplicitStep::potential(const VectorX& velocity, const VectorX& damping_force,
                                      const VectorX& acceleration, const VectorX& inertia) const noexcept {
  return 0.5 / velocity_per_displacement() * velocity.dot(damping_force) +
         0.5 / acceleration_per_displacement() * acceleration.dot(inertia);
}

}  // namespace detail

}}  // namespace palpate
