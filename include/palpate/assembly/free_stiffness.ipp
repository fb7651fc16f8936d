// Definitions of free_stiffness.hpp.
#pragma once

#include <palpate/assembly/free_stiffness.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double free_norm(const BlockMatrix& k, const EssentialConditions& conditions) {
  VectorX sums = VectorX::Zero(conditions.free_count());
  for_each_free_entry(k, conditions, [&](Index row, Index column, double value) {
    sums[column] += std::abs(value);
    if (row != column) sums[row] += std::abs(value);
  });
  return sums.size() > 0 ? sums.maxCoeff() : 0.0;
}

}}  // namespace palpate
