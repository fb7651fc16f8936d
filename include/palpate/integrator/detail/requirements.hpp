// Checks and conversions of the arguments of motions.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Throws bad_argument for Rayleigh coefficients that are negative (they would add energy) or not finite.
void require_damping(double mass_damping, double stiffness_damping);

/// Throws bad_argument for a vector that does not have one entry per dof.
void require_entries(const VectorX& v, Index dofs);

/// Converts nodal masses to one mass per dof, three equal ones per node.
VectorX mass_of_dofs(const VectorX& nodal_mass);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/integrator/detail/requirements.ipp>
#endif
