// The change of volume of tetrahedra in lanes, watched while their force is computed.
#pragma once

#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/assembly/tetrahedron_batches.hpp>

namespace palpate::inline PALPATE_ABI::detail {

/// Least J, in which batch, how many are not positive, and whether one is not finite, per lane. One per block.
template <class S, int N>
struct VolumeWatch {
  Lanes<S, N> smallest{std::numeric_limits<S>::infinity()}, batch{S(-1)}, inverted{S(0)}, broken{S(0)}, at{S(0)};

  /// Batches in their order; lanes without an element have no volume and are not seen.
  PALPATE_ALWAYS_INLINE void see(const Lanes<S, N>& j, const Lanes<S, N>& volume) noexcept {
    const auto present = volume > Lanes<S, N>(S(0)), ahead = (j < smallest) & present;
    smallest = select(ahead, j, smallest);
    batch = select(ahead, at, batch);
    broken += j - j;  // zero, or NaN from then on
    inverted += select((j > Lanes<S, N>(S(0))) | !present, Lanes<S, N>(S(0)), Lanes<S, N>(S(1)));
    at += Lanes<S, N>(S(1));
  }

  DeformationReport report(const TetrahedronBatches<S, N>& layout, const TetrahedronBlock& block,
                           bool survives_inversion) const noexcept {
    DeformationReport r;
    for (int lane = 0; lane < N; ++lane) {
      r.inverted += static_cast<Index>(inverted[lane]);
      r.admissible = r.admissible && broken[lane] == S(0);
      if (!(smallest[lane] < r.smallest_volume_ratio)) continue;
      r.smallest_volume_ratio = static_cast<double>(smallest[lane]);
      const auto b = static_cast<std::size_t>(block.first_batch + static_cast<Index>(batch[lane]));
      r.worst_element = layout.elements[b][static_cast<std::size_t>(lane)];
    }
    r.admissible = r.admissible && (survives_inversion || r.inverted == 0);
    return r;
  }
};

/// One report of all blocks.
inline DeformationReport merged(const std::vector<DeformationReport>& parts) noexcept {
  DeformationReport all;
  for (const DeformationReport& part : parts) {
    if (part.smallest_volume_ratio < all.smallest_volume_ratio) {
      all.smallest_volume_ratio = part.smallest_volume_ratio;
      all.worst_element = part.worst_element;
    }
    all.inverted += part.inverted;
    all.admissible = all.admissible && part.admissible;
  }
  return all;
}

}  // namespace palpate::inline PALPATE_ABI::detail
