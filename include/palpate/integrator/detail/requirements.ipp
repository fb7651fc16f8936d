// Definitions of requirements.hpp.
#pragma once

#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/core/setup_error.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void require_damping(double mass_damping, double stiffness_damping) {
  for (const double d : {mass_damping, stiffness_damping})
    if (!(d >= 0.0 && d < infinity))
      raise(SetupErrorKind::bad_argument, "the damping coefficient is " + number(d), "Give 0 or a positive number");
}

PALPATE_INLINE void require_entries(const VectorX& v, Index dofs) {
  if (v.size() != dofs)
    raise(SetupErrorKind::bad_argument, std::to_string(v.size()) + " entries for " + std::to_string(dofs) + " dofs",
          "Give three entries per node");
}

PALPATE_INLINE void require_mass_left(const VectorX& before, const VectorX& nodal_mass) {
  if (3 * nodal_mass.size() != before.size())
    raise(SetupErrorKind::bad_argument, "there are " + std::to_string(nodal_mass.size()) + " masses for " +
                                            std::to_string(before.size() / 3) + " nodes");
  for (Index i = 0; i < nodal_mass.size(); ++i)
    if (!(nodal_mass[i] >= 0.0) || !(nodal_mass[i] <= before[3 * i] * (1.0 + 1e-9)))
      raise(SetupErrorKind::bad_density,
            "node " + std::to_string(i) + " has the mass " + number(nodal_mass[i]) + " after elements have left",
            "Give lumped_mass(body, gone)");
}

PALPATE_INLINE VectorX mass_of_dofs(const VectorX& nodal_mass) {
  VectorX mass(3 * nodal_mass.size());
  for (Index dof = 0; dof < mass.size(); ++dof) mass[dof] = nodal_mass[dof / 3];
  return mass;
}

}}  // namespace palpate
