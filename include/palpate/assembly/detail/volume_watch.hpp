// Reports about the elements of a batched force: volume ratios, and which are beyond the range of their material.
#pragma once

#include <palpate/assembly/detail/tetrahedron_batches.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/material_range.hpp>

#include <algorithm>
#include <cstdint>
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

/// Counts the lanes of every batch whose F is beyond the range. Where the material knows a volume ratio above which
/// there are none, every evaluation examines all batches, most of them by one comparison. For other materials an
/// examination takes 2 us: an evaluation examines about 64 batches, in turn, and the others keep their count. Those
/// that are beyond the range are examined more often, so that the count falls soon after they are back.
template <class M, class S, int N>
class RangeWatch {
 public:
  static constexpr bool by_volume = RangedByVolume<M>;

  void resize(std::size_t batches) {
    beyond_.assign(batches, 0);
    period_ = std::clamp<std::size_t>(batches / examined_batches, 1, longest_period);
  }
  /// Begins an evaluation.
  void next_turn() noexcept { ++turn_; }
  bool is_turn_of(std::size_t batch) const noexcept {
    if constexpr (by_volume) return true;
    const std::size_t period = beyond_[batch] > 0 ? std::min(period_, shortest_period) : period_;
    return (batch + turn_) % period == 0;
  }

  /// Lanes without volume are empty.
  PALPATE_ALWAYS_INLINE void observe(std::size_t batch, const M& material, const Tensor3<Lanes<S, N>>& f,
                                     const Lanes<S, N>& volume) noexcept {
    if (is_turn_of(batch)) examine(batch, material, f, volume);
  }
  /// The sum over batches.
  Index count(std::size_t first, std::size_t last) const noexcept {
    Index sum = 0;
    for (std::size_t b = first; b < last; ++b) sum += beyond_[b];
    return sum;
  }
  Index count() const noexcept { return count(0, beyond_.size()); }

 private:
  static constexpr std::size_t examined_batches = 64, longest_period = 128, shortest_period = 8;

  void examine(std::size_t batch, const M& material, const Tensor3<Lanes<S, N>>& f,
               const Lanes<S, N>& volume) noexcept {
    int beyond = 0;
    const auto examine_where = [&](const auto& mask) {
      for (int lane = 0; lane < N; ++lane)
        if (mask[lane] && volume[lane] > S(0)) beyond += is_beyond(material, f, lane) ? 1 : 0;
    };
    if constexpr (by_volume) {
      examine_where(determinant(f) < Lanes<S, N>(static_cast<S>(material.range_volume_ratio())));
    } else {
      const Tensor3<Lanes<S, N>> strain = plus_identity(transpose_product(f, f), Lanes<S, N>(S(-1)));
      examine_where(Lanes<S, N>(static_cast<S>(examined_strain)) < contract(strain, strain));
    }
    beyond_[batch] = static_cast<std::uint8_t>(beyond);
  }
  static bool is_beyond(const M& material, const Tensor3<Lanes<S, N>>& f, int lane) noexcept {
    Tensor3<double> own;
    for (int e = 0; e < 9; ++e) own.e[e] = static_cast<double>(f.e[e][lane]);
    return is_beyond_range(material, own);
  }

  std::vector<std::uint8_t> beyond_;  // by batch
  std::size_t period_ = 1, turn_ = 0;
};

}}}  // namespace palpate::detail
