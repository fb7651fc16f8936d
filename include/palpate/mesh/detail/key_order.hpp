// Sorts sets of nodes, so that equal sets are adjacent.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The numbers that distinguish most keys with the same first number, stored compactly.
struct ShortKey {
  NodeId second = 0, third = 0;
  Index place = 0;
};

/// Comparison of keys with the same first number.
class LessKey {
 public:
  LessKey(const NodeId* keys, int width) : keys_(keys), width_(width) {}

  bool operator()(const ShortKey& a, const ShortKey& b) const noexcept {
    if (a.second != b.second) return a.second < b.second;
    if (a.third != b.third) return a.third < b.third;
    const NodeId *x = keys_ + a.place * width_, *y = keys_ + b.place * width_;
    for (int i = 3; i < width_; ++i)
      if (x[i] != y[i]) return x[i] < y[i];
    return a.place < b.place;
  }

 private:
  const NodeId* keys_;
  int width_;
};

/// The order of keys of `width` numbers each, compared lexicographically; equal keys are ordered by their place in
/// `keys`. The first number of each must be 0 ... node_count - 1. O(keys) for sets of nodes of a mesh; allocates.
inline std::vector<Index> key_order(const std::vector<NodeId>& keys, int width, Index node_count) {
  // Counting sort by the first number; then only the few keys around each node remain to be sorted.
  const auto count = static_cast<Index>(keys.size()) / width;
  std::vector<Index> start(static_cast<std::size_t>(node_count) + 1, 0);
  const NodeId* key = keys.data();
  for (Index i = 0; i < count; ++i, key += width) ++start[static_cast<std::size_t>(key[0]) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<ShortKey> sorted(static_cast<std::size_t>(count));
  std::vector<Index> next(start.begin(), start.end() - 1);
  key = keys.data();
  for (Index i = 0; i < count; ++i, key += width)
    sorted[static_cast<std::size_t>(next[static_cast<std::size_t>(key[0])]++)] = {width > 1 ? key[1] : 0,
                                                                                  width > 2 ? key[2] : 0, i};
  const LessKey less(keys.data(), width);
  for (std::size_t i = 0; i + 1 < start.size(); ++i)
    std::sort(sorted.begin() + start[i], sorted.begin() + start[i + 1], less);
  std::vector<Index> order(sorted.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = sorted[i].place;
  return order;
}

}}}  // namespace palpate::detail
