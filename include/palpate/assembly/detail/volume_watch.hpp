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

/// VolumeLanes with a report.
template <class S, int N>
class VolumeWatch {
 public:
  PALPATE_ALWAYS_INLINE void observe(const Lanes<S, N>& j, const Lanes<S, N>& volume) noexcept {
    lanes_.observe(j, volume);
  }
  /// Takes over the lanes that a kernel has written (any_flags::TetrahedronJob).
  void read(const S* volumes) noexcept {
    lanes_.smallest = Lanes<S, N>::load(volumes);
    lanes_.batch = Lanes<S, N>::load(volumes + N);
    lanes_.upright = Lanes<S, N>::load(volumes + 2 * N);
    lanes_.broken = Lanes<S, N>::load(volumes + 3 * N);
  }

  /// The report of a block, after observe() of all its batches.
  DeformationReport summary(const TetrahedronBatches<S, N>& layout, const TetrahedronBlock& block,
                            bool survives_inversion) const noexcept {
    DeformationReport report;
    Index upright = 0;
    for (int lane = 0; lane < N; ++lane) {
      upright += static_cast<Index>(lanes_.upright[lane]);
      report.admissible = report.admissible && lanes_.broken[lane] == S(0);
      if (!(lanes_.smallest[lane] < report.smallest_volume_ratio)) continue;
      report.smallest_volume_ratio = static_cast<double>(lanes_.smallest[lane]);
      const auto at = static_cast<std::size_t>(block.first_batch + static_cast<Index>(lanes_.batch[lane]));
      report.worst_element = layout.elements[at][static_cast<std::size_t>(lane)];
    }
    report.inverted = block.batch_count * N - upright;
    report.admissible = report.admissible && (survives_inversion || report.inverted == 0);
    return report;
  }

 private:
  VolumeLanes<S, N> lanes_;
};

inline void add_report(const DeformationReport& part, DeformationReport& all) noexcept {
  if (part.smallest_volume_ratio < all.smallest_volume_ratio) {
    all.smallest_volume_ratio = part.smallest_volume_ratio;
    all.worst_element = part.worst_element;
  }
  all.inverted += part.inverted;
  all.beyond_range += part.beyond_range;
  all.admissible = all.admissible && part.admissible;
}

inline DeformationReport report_of(const std::vector<DeformationReport>& parts) noexcept {
  DeformationReport all;
  for (const DeformationReport& part : parts) add_report(part, all);
  return all;
}

}}}  // namespace palpate::detail
