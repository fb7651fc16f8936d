// Definitions of status.hpp.
#pragma once

#include <palpate/core/status.hpp>

#include <bit>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void StatusCounters::count(Status status) noexcept {
  for (std::uint32_t bits = status.bits(); bits != 0; bits &= bits - 1)
    ++counts_[static_cast<std::size_t>(std::countr_zero(bits))];
}

PALPATE_INLINE std::uint64_t StatusCounters::operator[](StatusFlag flag) const noexcept {
  return counts_[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(flag)))];
}

}}  // namespace palpate
