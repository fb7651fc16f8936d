// Definitions of energy_forces.hpp.
#pragma once

#include <palpate/assembly/detail/energy_forces.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double EnergyForces::evaluate_rotated(const std::vector<Vector3>& positions, VectorX& u,
                                                     VectorX& f) noexcept {
  Matrix3 turn;
  turn << 2.0, -1.0, 2.0, 2.0, 2.0, -1.0, -1.0, 2.0, 2.0;
  turn /= 3.0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    set_node_vector(u, static_cast<Index>(i), turn * positions[i] - positions[i]);
  DeformationReport report;
  return evaluate(u, f, report);
}

}}  // namespace palpate
