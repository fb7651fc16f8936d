// One-step schemes for second-order equations of motion.
#pragma once

#include <palpate/core/config.hpp>

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

}}  // namespace palpate
