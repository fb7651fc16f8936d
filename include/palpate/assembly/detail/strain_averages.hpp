// Averages of deformation gradients over the domains of smoothed tetrahedra, at any strain.
#pragma once

#include <palpate/assembly/detail/strain_domains.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The domains of one kind (edges or nodes) in batches of N of one region, each with weights of the elements around it
/// that sum to 1. Elements and domains are numbered by their place in the batches. 8 to 12 bytes per pair of a domain
/// and an element.
template <class S, int N>
class StrainAverages {
 public:
  /// N domains of one region; lanes without a domain have volume zero.
  struct Batch {
    Lanes<S, N> volume;
    int region = 0;
  };
  static constexpr int row_size = 12;  ///< numbers per tensor in memory: nine, padded

  StrainAverages() = default;
  /// The domains of `part`. `place[e]` is the place of element e, `element_volume[e]` its volume.
  template <class Domains>
  StrainAverages(const Domains& domains, StrainPart part, const std::vector<std::int32_t>& place,
                 const std::vector<double>& element_volume) {
    for (const Index d : sorted(domains, part, place)) {
      const StrainDomain domain = domains[d];
      const bool fits = !batches_.empty() && batches_.back().region == domain.region && size() % N != 0;
      if (!fits) open_batch(domain.region);
      batches_.back().volume.set(static_cast<int>(size() % N), static_cast<S>(domain.volume));
      double sum = 0.0;
      for (const NodeId e : domain.elements) sum += element_volume[static_cast<std::size_t>(e)];
      for (const NodeId e : domain.elements) {
        element_.push_back(place[static_cast<std::size_t>(e)]);
        weight_.push_back(static_cast<S>(element_volume[static_cast<std::size_t>(e)] / sum));
      }
      first_.push_back(element_.size());
    }
    fill_batch();
  }

  /// Number of domains, including those of empty lanes.
  Index size() const noexcept { return static_cast<Index>(first_.size()) - 1; }
  const std::vector<Batch>& batches() const noexcept { return batches_; }

  /// Calls visit(domain, element) for the places of all pairs.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t d = 0; d + 1 < first_.size(); ++d)
      for (std::size_t k = first_[d]; k < first_[d + 1]; ++k) visit(static_cast<std::int32_t>(d), element_[k]);
  }

  /// Weighted means of tensors, rows of `row_size`, over the domains of batch b; the identity in empty lanes.
  PALPATE_ALWAYS_INLINE Tensor3<Lanes<S, N>> mean_tensors(std::size_t b, const S* rows) const noexcept {
    Tensor3<Lanes<S, N>> mean;
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t d = b * N + static_cast<std::size_t>(lane);
      using Row = Lanes<S, 4>;
      Row sum[3] = {Row(S(0)), Row(S(0)), Row(S(0))};
      for (std::size_t k = first_[d]; k < first_[d + 1]; ++k) {
        const S* const row = rows + row_size * std::ptrdiff_t{element_[k]};
        const Row weight(weight_[k]);
        for (int i = 0; i < 3; ++i) sum[i] += weight * Row::load(row + 4 * i);
      }
      if (first_[d] == first_[d + 1]) sum[0].set(0, S(1)), sum[1].set(0, S(1)), sum[2].set(0, S(1));
      for (int i = 0; i < 9; ++i) mean.e[i].set(lane, sum[i / 4][i % 4]);
    }
    return mean;
  }
  /// Weighted means of numbers, one per element; `empty` in empty lanes.
  PALPATE_ALWAYS_INLINE Lanes<S, N> mean_numbers(std::size_t b, const S* numbers, S empty = S(1)) const noexcept {
    Lanes<S, N> mean;
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t d = b * N + static_cast<std::size_t>(lane);
      S sum = first_[d] == first_[d + 1] ? empty : S(0);
      for (std::size_t k = first_[d]; k < first_[d + 1]; ++k)
        sum += weight_[k] * numbers[static_cast<std::size_t>(element_[k])];
      mean.set(lane, sum);
    }
    return mean;
  }

 private:
  /// Domains by region, then in the order of their first element.
  template <class Domains>
  static std::vector<Index> sorted(const Domains& domains, StrainPart part, const std::vector<std::int32_t>& place) {
    struct Key {
      int region;
      std::int32_t first;
      Index domain;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    for (Index d = 0; d < domains.size(); ++d) {
      const StrainDomain domain = domains[d];
      if (domain.part != part) continue;
      std::int32_t first = std::numeric_limits<std::int32_t>::max();
      for (const NodeId e : domain.elements) first = std::min(first, place[static_cast<std::size_t>(e)]);
      keys.push_back({domain.region, first, d});
    }
    std::ranges::sort(keys);
    std::vector<Index> order;
    for (const Key& key : keys) order.push_back(key.domain);
    return order;
  }
  void open_batch(int region) {
    fill_batch();
    batches_.push_back({Lanes<S, N>(S(0)), region});
  }
  void fill_batch() {
    while (size() % N != 0) first_.push_back(element_.size());
  }

  std::vector<Batch> batches_;
  std::vector<std::size_t> first_{0};
  std::vector<std::int32_t> element_;
  std::vector<S> weight_;
};

}}  // namespace palpate
