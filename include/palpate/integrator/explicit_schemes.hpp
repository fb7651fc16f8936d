// Explicit schemes for motion: central differences (second order) and semi-implicit Euler (first order).
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Sets the velocity of constrained dofs to zero. With their inverse mass of zero they are then unaffected by updates
/// of all dofs.
inline void clear_constrained_velocity(MotionState& s) noexcept {
  for (Index dof : s.constrained) s.velocity[dof] = 0.0;
}

/// Moves constrained dofs towards their targets at constant speed; show_constrained reports that speed as velocity.
inline void move_constrained(MotionState& s, double dt) noexcept {
  for (std::size_t k = 0; k < s.constrained.size(); ++k) {
    const Index dof = s.constrained[k];
    s.prescribed_speed[static_cast<Index>(k)] = (s.target[dof] - s.displacement[dof]) / dt;
    s.displacement[dof] = s.target[dof];
  }
}

inline void show_constrained(MotionState& s) noexcept {
  for (std::size_t k = 0; k < s.constrained.size(); ++k)
    s.velocity[s.constrained[k]] = s.prescribed_speed[static_cast<Index>(k)];
}

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
