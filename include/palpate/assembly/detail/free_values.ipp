// Definitions of free_values.hpp.
#pragma once

#include <palpate/assembly/detail/free_values.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE FreeValues::FreeValues(const BlockMatrix& k, const EssentialConditions& conditions)
    : lower_(free_matrix(k, conditions)) {
  place_.reserve(static_cast<std::size_t>(lower_.nonZeros()));
  std::vector<Index> next(lower_.outerIndexPtr(), lower_.outerIndexPtr() + lower_.cols());
  for_each_free_entry(k, conditions,
                      [&](Index, Index column, double) { place_.push_back(next[static_cast<std::size_t>(column)]++); });
}

PALPATE_INLINE void FreeValues::update(const BlockMatrix& k, const EssentialConditions& conditions) noexcept {
  auto place = place_.begin();
  double* const values = lower_.valuePtr();
  for_each_free_entry(k, conditions, [&](Index, Index, double value) { values[*place++] = value; });
}

PALPATE_INLINE void FreeValues::add_to_diagonal(double value) noexcept {
  for (Index j = 0; j < lower_.cols(); ++j) lower_.valuePtr()[lower_.outerIndexPtr()[j]] += value;
}

PALPATE_INLINE double FreeValues::gershgorin_shift(VectorX& sums) const noexcept {
  sums.setZero();
  for (Index j = 0; j < lower_.cols(); ++j) {
    const Index first = lower_.outerIndexPtr()[j];
    sums[j] -= lower_.valuePtr()[first];
    for (Index p = first + 1; p < lower_.outerIndexPtr()[j + 1]; ++p) {
      const double size = std::abs(lower_.valuePtr()[p]);
      sums[j] += size;
      sums[lower_.innerIndexPtr()[p]] += size;
    }
  }
  return sums.allFinite() ? std::max(0.0, sums.maxCoeff()) : std::numeric_limits<double>::quiet_NaN();
}

}}  // namespace palpate
