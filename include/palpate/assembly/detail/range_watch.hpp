// Which elements of a batched force are deformed beyond the range of their material.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/detail/material_range.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
