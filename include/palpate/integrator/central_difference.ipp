// Definitions of central_difference.hpp.
#pragma once

#include <palpate/integrator/central_difference.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void leave_out_held(MotionState& s) noexcept {
  for (Index dof : s.held) s.velocity[dof] = 0.0;
}

PALPATE_INLINE void move_held(MotionState& s, double dt) noexcept {
  for (std::size_t k = 0; k < s.held.size(); ++k) {
    const Index dof = s.held[k];
    s.held_speed[static_cast<Index>(k)] = (s.target[dof] - s.displacement[dof]) / dt;
    s.displacement[dof] = s.target[dof];
  }
}

PALPATE_INLINE void show_held(MotionState& s) noexcept {
  for (std::size_t k = 0; k < s.held.size(); ++k) s.velocity[s.held[k]] = s.held_speed[static_cast<Index>(k)];
}

}}}  // namespace palpate::detail
