// Reduces velocities until their kinetic energy is available.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Scales velocities `v` [m/s] down until the kinetic energy is at most `available` [J]; unchanged when it is. `mass`
/// [kg] of every dof, three per node. A free body keeps its momentum: only velocities relative to the mean are scaled.
/// No allocation.
void limit_kinetic_energy(double available, const VectorX& mass, bool is_free, VectorX& v) noexcept;

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/integrator/detail/kinetic_limit.ipp>
#endif
