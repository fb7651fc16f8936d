// Checks and conversions of the arguments of motions.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Throws bad_argument for Rayleigh coefficients that are negative (they would add energy) or not finite.
void require_damping(double mass_damping, double stiffness_damping);

/// Throws bad_argument for a vector that does not have one entry per dof.
void require_entries(const VectorX& v, Index dofs);

/// Checks the nodal masses [kg] that remain after elements have left, against `before` [kg], of every dof. Throws
/// bad_argument for a wrong size, bad_density for a node that is heavier than before or has a negative mass.
void require_mass_left(const VectorX& before, const VectorX& nodal_mass);

/// Converts nodal masses to one mass per dof, three equal ones per node.
VectorX mass_of_dofs(const VectorX& nodal_mass);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/integrator/detail/requirements.ipp>
#endif
