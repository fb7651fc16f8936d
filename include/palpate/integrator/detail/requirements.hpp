// What motions require of what they are given, and make of it.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Throws bad_argument for Rayleigh's coefficients that would add energy, or are none.
void require_damping(double mass_damping, double stiffness_damping);

/// Throws bad_argument for a vector that has not one entry per dof.
void require_entries(const VectorX& v, Index dofs);

/// Nodal masses as one per dof, three equal ones per node.
VectorX mass_of_dofs(const VectorX& nodal_mass);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/integrator/detail/requirements.ipp>
#endif
