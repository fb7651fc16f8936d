// Definitions of duration_histogram.hpp.
#pragma once

#include <palpate/haptic/duration_histogram.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void DurationHistogram::record(double seconds) noexcept {
  const double ns = seconds * 1e9;
  const std::uint64_t n = ns >= 1.0 ? (ns < 0x1p40 ? static_cast<std::uint64_t>(ns) : std::uint64_t{1} << 40) : 0;
  ++counts_[static_cast<std::size_t>(bin_of(n))];
  ++total_;
  if (seconds > max_) max_ = seconds;
}

PALPATE_INLINE double DurationHistogram::percentile(double p) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(p * static_cast<double>(total_)));
  std::uint64_t seen = 0;
  for (int bin = 0; bin < bins; ++bin)
    if ((seen += count(bin)) >= wanted && seen > 0) return std::min(low(bin + 1), max_);
  return max_;
}

PALPATE_INLINE double DurationHistogram::low(int bin) noexcept {
  if (bin < 64) return 1e-9 * bin;
  return 1e-9 * std::ldexp(64.0 + bin % 64, bin / 64 - 1);
}

PALPATE_INLINE int DurationHistogram::bin_of(std::uint64_t ns) noexcept {
  if (ns < 64) return static_cast<int>(ns);
  const int shift = static_cast<int>(std::bit_width(ns)) - 7;
  return std::min(64 * shift + static_cast<int>(ns >> shift), bins - 1);
}

}}  // namespace palpate
