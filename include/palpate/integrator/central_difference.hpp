// Second-order explicit integration.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Sets the velocity of constrained dofs to zero. With their inverse mass of zero they are then unaffected by updates
/// of all dofs.
void clear_constrained_velocity(MotionState& s) noexcept;
/// Moves constrained dofs towards their targets at constant speed; show_constrained reports that speed as velocity.
void move_constrained(MotionState& s, double dt) noexcept;
void show_constrained(MotionState& s) noexcept;

}  // namespace detail

/// Central differences (Belytschko, Liu, Moran, Nonlinear Finite Elements, 6.2), as half a velocity update, a position
/// update, half a velocity update: u and v belong to the same time, the step may change, and with a constant step the
/// displacements satisfy
///   u_n+1 = [dt^2 (R - F) / m + 2 u_n - (1 - alpha dt/2) u_n-1] / (1 + alpha dt/2).
/// Order 2; symplectic without damping: energy does not drift, momentum is exact. Stable up to 2 / omega_max for any
/// alpha.
struct CentralDifference {
  static constexpr int order = 2;

  template <class Refresh>
  static void step(MotionState& s, double dt, Refresh&& refresh) noexcept {
    const double half = 0.5 * dt, shrink = 1.0 / (1.0 + s.damping * half), keep = 1.0 - s.damping * half;
    detail::clear_constrained_velocity(s);
    s.velocity = shrink * (s.velocity + half * (s.load - s.force).cwiseProduct(s.inverse_mass));
    s.displacement += dt * s.velocity;
    detail::move_constrained(s, dt);
    refresh();
    s.velocity = keep * s.velocity + half * (s.load - s.force).cwiseProduct(s.inverse_mass);
    detail::show_constrained(s);
    s.time += dt;
  }
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/integrator/central_difference.ipp>
#endif
