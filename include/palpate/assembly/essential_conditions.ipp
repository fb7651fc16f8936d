// Definitions of essential_conditions.hpp.
#pragma once

#include <palpate/assembly/essential_conditions.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void EssentialConditions::gather(const VectorX& full, VectorX& free_part) const noexcept {
  for (Index k = 0; k < free_count(); ++k) free_part[k] = full[free_dofs[static_cast<std::size_t>(k)]];
}

PALPATE_INLINE void EssentialConditions::place(const VectorX& free_part, const VectorX& held,
                                               VectorX& full) const noexcept {
  full = held;
  for (Index k = 0; k < free_count(); ++k) full[free_dofs[static_cast<std::size_t>(k)]] = free_part[k];
}

PALPATE_INLINE void EssentialConditions::scatter(const VectorX& free_part, VectorX& full) const noexcept {
  full.setZero();
  for (Index k = 0; k < free_count(); ++k) full[free_dofs[static_cast<std::size_t>(k)]] = free_part[k];
}

}}  // namespace palpate
