// First-order explicit integration: velocity first, then position.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/integrator/central_difference.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Semi-implicit Euler, as in Bro-Nielsen's models: v_n+1 = (v_n + dt (R - F(u_n)) / m) / (1 + alpha dt), u_n+1 = u_n +
/// dt v_n+1. Order 1, symplectic; its displacements are those of central differences with the start shifted by half a
/// step. Stable up to 2 / omega_max.
struct SemiImplicitEuler {
  static constexpr int order = 1;

  template <class Refresh>
  static void step(MotionState& s, double dt, Refresh&& refresh) noexcept {
    const double shrink = 1.0 / (1.0 + s.damping * dt);
    detail::clear_constrained_velocity(s);
    s.velocity = shrink * (s.velocity + dt * (s.load - s.force).cwiseProduct(s.inverse_mass));
    s.displacement += dt * s.velocity;
    detail::move_constrained(s, dt);
    refresh();
    detail::show_constrained(s);
    s.time += dt;
  }
};

}}  // namespace palpate
