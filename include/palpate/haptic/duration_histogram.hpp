// Histogram of latencies.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/duration_histogram.ipp>
#endif
