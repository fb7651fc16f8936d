// Definitions of status.hpp.
#pragma once

#include <palpate/core/status.hpp>

#include <bit>
#include <ostream>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, Status status) {
  if (status.ok()) return out << "ok";
  const char* between = "";
  for (int bit = 0; bit < status_flag_count; ++bit) {
    if ((status.bits() >> bit & 1u) == 0) continue;
    out << between << status_flag_name(bit);
    between = " ";
  }
  return out;
}

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const StatusCounters& counters) {
  const char* between = "";
  for (int bit = 0; bit < status_flag_count; ++bit) {
    if (counters.at(bit) == 0) continue;
    out << between << status_flag_name(bit) << ' ' << counters.at(bit);
    between = " ";
  }
  return *between == 0 ? out << "ok" : out;
}

PALPATE_INLINE void StatusCounters::count(Status status) noexcept {
  for (std::uint32_t bits = status.bits(); bits != 0; bits &= bits - 1)
    ++counts_[static_cast<std::size_t>(std::countr_zero(bits))];
}

PALPATE_INLINE std::uint64_t StatusCounters::operator[](StatusFlag flag) const noexcept {
  return counts_[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(flag)))];
}

}}  // namespace palpate
