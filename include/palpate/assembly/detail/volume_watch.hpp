// Volume ratios of the elements of a batched force.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batches.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Adds the report of one part of a body to that of another.
void add_report(const DeformationReport& part, DeformationReport& all) noexcept;

/// The combined report of all parts.
DeformationReport report_of(const std::vector<DeformationReport>& parts) noexcept;

/// Per lane: smallest J of a block, its batch, the number of positive J, and whether one is not finite.
template <class S, int N>
class VolumeWatch {
 public:
  /// Adds a batch: its J, and its volumes at rest. Lanes without an element have volume zero and do not count.
  PALPATE_ALWAYS_INLINE void observe(const Lanes<S, N>& j, const Lanes<S, N>& volume) noexcept {
    const Lanes<S, N> none(std::numeric_limits<S>::infinity()), zero(S(0)), one(S(1));
    const Lanes<S, N> seen = select(volume > zero, j, none);
    const auto ahead = seen < smallest_;
    smallest_ = select(ahead, seen, smallest_);
    batch_ = select(ahead, Lanes<S, N>(at_), batch_);
    broken_ += j - j;  // zero; NaN once a J was not finite
    upright_ += select(seen > zero, one, zero);
    at_ += S(1);
  }

  /// The report of a block, after observe() of all its batches.
  DeformationReport summary(const TetrahedronBatches<S, N>& layout, const TetrahedronBlock& block,
                            bool survives_inversion) const noexcept {
    DeformationReport report;
    Index upright = 0;
    for (int lane = 0; lane < N; ++lane) {
      upright += static_cast<Index>(upright_[lane]);
      report.admissible = report.admissible && broken_[lane] == S(0);
      if (!(smallest_[lane] < report.smallest_volume_ratio)) continue;
      report.smallest_volume_ratio = static_cast<double>(smallest_[lane]);
      const auto at = static_cast<std::size_t>(block.first_batch + static_cast<Index>(batch_[lane]));
      report.worst_element = layout.elements[at][static_cast<std::size_t>(lane)];
    }
    report.inverted = block.batch_count * N - upright;
    report.admissible = report.admissible && (survives_inversion || report.inverted == 0);
    return report;
  }

 private:
  Lanes<S, N> smallest_{std::numeric_limits<S>::infinity()}, batch_{S(-1)}, upright_{S(0)}, broken_{S(0)};
  S at_ = S(0);
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/volume_watch.ipp>
#endif
