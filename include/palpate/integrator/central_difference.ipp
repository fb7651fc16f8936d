// Definitions of central_difference.hpp.
#pragma once

#include <palpate/integrator/central_difference.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void clear_constrained_velocity(MotionState& s) noexcept {
  for (Index dof : s.constrained) s.velocity[dof] = 0.0;
}

PALPATE_INLINE void move_constrained(MotionState& s, double dt) noexcept {
  for (std::size_t k = 0; k < s.constrained.size(); ++k) {
    const Index dof = s.constrained[k];
    s.prescribed_speed[static_cast<Index>(k)] = (s.target[dof] - s.displacement[dof]) / dt;
    s.displacement[dof] = s.target[dof];
  }
}

PALPATE_INLINE void show_constrained(MotionState& s) noexcept {
  for (std::size_t k = 0; k < s.constrained.size(); ++k)
    s.velocity[s.constrained[k]] = s.prescribed_speed[static_cast<Index>(k)];
}

}}}  // namespace palpate::detail
