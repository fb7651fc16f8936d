// Checks and conversions of the arguments of motions.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Throws bad_argument for Rayleigh coefficients that are negative (they would add energy) or not finite.
void require_damping(double mass_damping, double stiffness_damping);

/// Throws bad_argument for a vector that does not have one entry per dof.
void require_entries(const VectorX& v, Index dofs);

/// Converts nodal masses to one mass per dof, three equal ones per node.
VectorX mass_of_dofs(const VectorX& nodal_mass);

inline void require_damping(double mass_damping, double stiffness_damping) {
  for (const double d : {mass_damping, stiffness_damping})
    if (!(d >= 0.0 && d < infinity))
      raise(SetupErrorKind::bad_argument, "the damping coefficient is " + number(d), "Give 0 or a positive number");
}

inline void require_entries(const VectorX& v, Index dofs) {
  if (v.size() != dofs)
    raise(SetupErrorKind::bad_argument, std::to_string(v.size()) + " entries for " + std::to_string(dofs) + " dofs",
          "Give three entries per node");
}

inline VectorX mass_of_dofs(const VectorX& nodal_mass) {
  VectorX mass(3 * nodal_mass.size());
  for (Index dof = 0; dof < mass.size(); ++dof) mass[dof] = nodal_mass[dof / 3];
  return mass;
}

}}}  // namespace palpate::detail
