// What motions require of what they are given.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Throws bad_argument for Rayleigh's coefficients that would add energy, or are none.
inline void require_damping(double mass_damping, double stiffness_damping) {
  for (const double d : {mass_damping, stiffness_damping})
    if (!(d >= 0.0 && d < infinity))
      raise(SetupErrorKind::bad_argument, "a damping of " + number(d), "Give 0 or a positive number");
}

/// Throws bad_argument for a vector that has not one entry per dof.
inline void require_entries(const VectorX& v, Index dofs) {
  if (v.size() != dofs)
    raise(SetupErrorKind::bad_argument, std::to_string(v.size()) + " entries for " + std::to_string(dofs) + " dofs",
          "Give three per node");
}

}}  // namespace palpate
