// Histogram of latencies.
#pragma once

#include <palpate/core/config.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace palpate { inline namespace PALPATE_ABI {

/// Histogram of durations from 1 ns to 18 min in bins at most 1.6 % wide. `record` costs a few instructions.
class DurationHistogram {
 public:
  static constexpr int bins = 64 * 35;

  /// Negative durations and NaN count as zero.
  void record(double seconds) noexcept;

  /// The duration [s] that a fraction `p` in (0, 1] of all durations does not exceed: the upper end of its bin, never
  /// more than max();
  /// zero when nothing was recorded.
  double percentile(double p) const noexcept;
  double max() const noexcept { return max_; }  ///< [s] exact
  std::uint64_t total() const noexcept { return total_; }
  std::uint64_t count(int bin) const noexcept { return counts_[static_cast<std::size_t>(bin)]; }
  /// [s] lower end of a bin; low(bin + 1) is its upper end.
  static double low(int bin) noexcept;

 private:
  /// One bin per ns from 0 to 63 ns, then 64 bins per doubling.
  static int bin_of(std::uint64_t ns) noexcept;

  std::array<std::uint64_t, bins> counts_{};
  std::uint64_t total_ = 0;
  double max_ = 0.0;
};

inline void DurationHistogram::record(double seconds) noexcept {
  const double ns = seconds * 1e9;
  const std::uint64_t n = ns >= 1.0 ? (ns < 0x1p40 ? static_cast<std::uint64_t>(ns) : std::uint64_t{1} << 40) : 0;
  ++counts_[static_cast<std::size_t>(bin_of(n))];
  ++total_;
  if (seconds > max_) max_ = seconds;
}

inline double DurationHistogram::percentile(double p) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(p * static_cast<double>(total_)));
  std::uint64_t seen = 0;
  for (int bin = 0; bin < bins; ++bin)
    if ((seen += count(bin)) >= wanted && seen > 0) return std::min(low(bin + 1), max_);
  return max_;
}

inline double DurationHistogram::low(int bin) noexcept {
  if (bin < 64) return 1e-9 * bin;
  return 1e-9 * std::ldexp(64.0 + bin % 64, bin / 64 - 1);
}

inline int DurationHistogram::bin_of(std::uint64_t ns) noexcept {
  if (ns < 64) return static_cast<int>(ns);
  const int shift = static_cast<int>(std::bit_width(ns)) - 7;
  return std::min(64 * shift + static_cast<int>(ns >> shift), bins - 1);
}

}}  // namespace palpate
