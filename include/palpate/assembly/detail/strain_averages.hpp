// Averages of deformation gradients over the domains of smoothed tetrahedra, at any strain.
#pragma once

#include <palpate/assembly/detail/strain_domains.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
        lists_.element.push_back(place[static_cast<std::size_t>(e)]);
        lists_.weight.push_back(static_cast<S>(element_volume[static_cast<std::size_t>(e)] / sum));
      }
      lists_.first.push_back(lists_.element.size());
      ends_.push_back(domain.ends);
    }
    fill_batch();
  }

  /// Follows a cut: the domains `changed`, ascending, lose elements or are divided. `after(ends, element)` has the ends
  /// of an edge of an element after the cut, `none` for an element that is gone. Domains keep their numbers, the
  /// further parts of divided ones follow: moved(element, from, to) is called for their elements. `volume` of elements
  /// by place; `share` of an element in a domain. Every domain is as in a new object. O(pairs).
  template <class After, class Moved>
  void follow(const std::vector<std::int32_t>& changed, const std::vector<double>& volume, double share, After&& after,
              Moved&& moved) {
    const Lists old = std::exchange(lists_, {});
    lists_.first = {0};
    lists_.element.reserve(old.element.size());
    lists_.weight.reserve(old.weight.size());
    std::vector<Part> further;
    std::size_t d = 0;
    const auto keep_until = [&](std::size_t end) {
      for (; d < end; ++d) copy(old, d);
    };
    for (const std::int32_t next : changed) {
      keep_until(static_cast<std::size_t>(next));
      std::vector<Part> parts = divided(old, d, after);
      ends_[d] = parts.empty() ? none : parts[0].ends;
      set(d, parts.empty() ? std::vector<std::int32_t>{} : parts[0].elements, volume, share);
      for (std::size_t k = 1; k < parts.size(); ++k) {
        parts[k].from = next;
        further.push_back(std::move(parts[k]));
      }
      ++d;
    }
    keep_until(ends_.size());
    for (const Part& part : further) {
      const auto to = static_cast<std::int32_t>(append(part, volume, share));
      for (const std::int32_t e : part.elements) moved(e, part.from, to);
    }
    fill_batch();
  }
  using Ends = std::array<NodeId, 2>;
  static constexpr Ends none{-1, -1};

  /// Number of domains, including those of empty lanes.
  Index size() const noexcept { return static_cast<Index>(lists_.first.size()) - 1; }
  const std::vector<Batch>& batches() const noexcept { return batches_; }

  /// Calls visit(domain, element) for the places of all pairs.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (std::size_t d = 0; d + 1 < lists_.first.size(); ++d)
      for (std::size_t k = lists_.first[d]; k < lists_.first[d + 1]; ++k)
        visit(static_cast<std::int32_t>(d), lists_.element[k]);
  }

  /// Weighted means of tensors, rows of `row_size`, over the domains of batch b; the identity in empty lanes.
  PALPATE_ALWAYS_INLINE Tensor3<Lanes<S, N>> mean_tensors(std::size_t b, const S* rows) const noexcept {
    Tensor3<Lanes<S, N>> mean;
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t d = b * N + static_cast<std::size_t>(lane);
      using Row = Lanes<S, 4>;
      Row sum[3] = {Row(S(0)), Row(S(0)), Row(S(0))};
      for (std::size_t k = lists_.first[d]; k < lists_.first[d + 1]; ++k) {
        const S* const row = rows + row_size * std::ptrdiff_t{lists_.element[k]};
        const Row weight(lists_.weight[k]);
        for (int i = 0; i < 3; ++i) sum[i] += weight * Row::load(row + 4 * i);
      }
      if (lists_.first[d] == lists_.first[d + 1]) sum[0].set(0, S(1)), sum[1].set(0, S(1)), sum[2].set(0, S(1));
      for (int i = 0; i < 9; ++i) mean.e[i].set(lane, sum[i / 4][i % 4]);
    }
    return mean;
  }
  /// Weighted means of numbers, one per element; `empty` in empty lanes.
  PALPATE_ALWAYS_INLINE Lanes<S, N> mean_numbers(std::size_t b, const S* numbers, S empty = S(1)) const noexcept {
    Lanes<S, N> mean;
    for (int lane = 0; lane < N; ++lane) {
      const std::size_t d = b * N + static_cast<std::size_t>(lane);
      S sum = lists_.first[d] == lists_.first[d + 1] ? empty : S(0);
      for (std::size_t k = lists_.first[d]; k < lists_.first[d + 1]; ++k)
        sum += lists_.weight[k] * numbers[static_cast<std::size_t>(lists_.element[k])];
      mean.set(lane, sum);
    }
    return mean;
  }

 private:
  /// Domains by region, then in the order of their first element.
  struct Part {
    Ends ends;
    std::vector<std::int32_t> elements;
    int region = 0;
    std::int32_t from = 0;  // domain before the cut
  };
  /// Elements and weights of all domains.
  struct Lists {
    std::vector<std::size_t> first{0};
    std::vector<std::int32_t> element;
    std::vector<S> weight;
  };

  void copy(const Lists& old, std::size_t d) {
    const auto first = static_cast<std::ptrdiff_t>(old.first[d]), last = static_cast<std::ptrdiff_t>(old.first[d + 1]);
    lists_.element.insert(lists_.element.end(), old.element.begin() + first, old.element.begin() + last);
    lists_.weight.insert(lists_.weight.end(), old.weight.begin() + first, old.weight.begin() + last);
    lists_.first.push_back(lists_.element.size());
  }
  /// The elements that are left of a domain, by the ends of their edge.
  template <class After>
  std::vector<Part> divided(const Lists& old, std::size_t d, After&& after) const {
    std::vector<Part> parts;
    for (std::size_t k = old.first[d]; k < old.first[d + 1]; ++k) {
      const Ends ends = after(ends_[d], old.element[k]);
      if (ends == none) continue;
      auto part = std::ranges::find(parts, ends, &Part::ends);
      if (part == parts.end()) part = parts.insert(part, {ends, {}, batches_[d / N].region});
      part->elements.push_back(old.element[k]);
    }
    return parts;
  }
  /// Appends the lists of domain d.
  void set(std::size_t d, const std::vector<std::int32_t>& elements, const std::vector<double>& volume, double share) {
    double sum = 0.0, own = 0.0;
    for (const std::int32_t e : elements) {
      sum += volume[static_cast<std::size_t>(e)];
      own += share * volume[static_cast<std::size_t>(e)];
    }
    for (const std::int32_t e : elements) {
      lists_.element.push_back(e);
      lists_.weight.push_back(static_cast<S>(volume[static_cast<std::size_t>(e)] / sum));
    }
    lists_.first.push_back(lists_.element.size());
    batches_[d / N].volume.set(static_cast<int>(d % N), static_cast<S>(own));
  }
  /// Adds a domain, in the last batch if it has room; returns its number.
  std::size_t append(const Part& part, const std::vector<double>& volume, double share) {
    while (ends_.back() == none && (ends_.size() - 1) % N != 0) {
      ends_.pop_back();
      lists_.first.pop_back();
    }
    if (batches_.back().region != part.region || ends_.size() % N == 0) open_batch(part.region);
    const std::size_t d = ends_.size();
    ends_.push_back(part.ends);
    set(d, part.elements, volume, share);
    return d;
  }
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
    while (size() % N != 0) {
      lists_.first.push_back(lists_.element.size());
      ends_.push_back(none);
    }
  }

  std::vector<Batch> batches_;
  Lists lists_;
  std::vector<Ends> ends_;  // of every domain; none in empty lanes
};

}}}  // namespace palpate::detail
