// Minimum degree ordering of a few dozen nodes, with bit sets.
#pragma once

#include <palpate/linear/detail/node_graph.hpp>

#include <array>
#include <bit>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Orders the small parts left by nested dissection. Neighbours outside the part count in the degrees, as far as they
/// fit into the bit sets. O(nodes x neighbours) operations on bit sets.
class LeafOrder {
 public:
  static constexpr Index max_nodes = 128;

  explicit LeafOrder(const NodeGraph& graph) : graph_(graph), bit_(graph.nodes(), -1) {}

  /// Puts `count` nodes, at most max_nodes, into elimination order. `outside(v)` is true for nodes eliminated later;
  /// nodes already eliminated are ignored.
  template <class Outside>
  void order(NodeId* nodes, Index count, Outside&& outside) {
    describe(nodes, count, outside);
    for (Index i = 0; i < count; ++i) degree_[static_cast<std::size_t>(i)] = popcount(row(i));
    Bits alive{};
    for (Index i = 0; i < count; ++i) set(alive, i);
    const std::array<NodeId, max_nodes> given = copy(nodes, count);
    for (Index step = 0; step < count; ++step) {
      Index best = -1;
      for_each(alive, [&](Index i) {
        if (best < 0 || degree_[static_cast<std::size_t>(i)] < degree_[static_cast<std::size_t>(best)]) best = i;
      });
      nodes[step] = given[static_cast<std::size_t>(best)];
      reset(alive, best);
      eliminate(best, alive);
    }
    for (NodeId v : touched_) bit_[v] = -1;
  }

 private:
  static constexpr std::size_t words = 4;
  using Bits = std::array<std::uint64_t, words>;

  static void set(Bits& b, Index i) noexcept { b[static_cast<std::size_t>(i >> 6)] |= std::uint64_t{1} << (i & 63); }
  static void reset(Bits& b, Index i) noexcept {
    b[static_cast<std::size_t>(i >> 6)] &= ~(std::uint64_t{1} << (i & 63));
  }
  static int popcount(const Bits& b) noexcept {
    int sum = 0;
    for (std::uint64_t w : b) sum += std::popcount(w);
    return sum;
  }
  template <class Visit>
  static void for_each(const Bits& b, Visit&& visit) {
    for (std::size_t w = 0; w < words; ++w)
      for (std::uint64_t left = b[w]; left != 0; left &= left - 1)
        visit(static_cast<Index>(w * 64) + std::countr_zero(left));
  }
  Bits& row(Index i) noexcept { return adjacent_[static_cast<std::size_t>(i)]; }
  static std::array<NodeId, max_nodes> copy(const NodeId* nodes, Index count) noexcept {
    std::array<NodeId, max_nodes> given{};
    std::copy(nodes, nodes + count, given.begin());
    return given;
  }

  template <class Outside>
  void describe(const NodeId* nodes, Index count, Outside&& outside) {
    touched_.clear();
    Index used = 0;
    const auto number = [&](NodeId v) {
      bit_[v] = static_cast<NodeId>(used++);
      touched_.push_back(v);
    };
    for (Index i = 0; i < count; ++i) number(nodes[i]);
    for (Index i = 0; i < count; ++i) {
      row(i) = Bits{};
      for (Index p = graph_.start[nodes[i]]; p < graph_.start[nodes[i] + 1]; ++p) {
        const NodeId u = graph_.neighbour[p];
        if (bit_[u] < 0 && (used == static_cast<Index>(64 * words) || !outside(u))) continue;
        if (bit_[u] < 0) number(u);
        set(row(i), bit_[u]);
      }
    }
  }

  void eliminate(Index pivot, const Bits& alive) {
    const Bits around = row(pivot);
    for_each(around, [&](Index i) {
      if (i >= max_nodes || (alive[static_cast<std::size_t>(i >> 6)] >> (i & 63) & 1u) == 0) return;
      for (std::size_t w = 0; w < words; ++w) row(i)[w] |= around[w];
      reset(row(i), pivot);
      reset(row(i), i);
      degree_[static_cast<std::size_t>(i)] = popcount(row(i));
    });
  }

  const NodeGraph& graph_;
  NodeVector bit_, touched_;
  std::array<Bits, max_nodes> adjacent_{};
  std::array<int, max_nodes> degree_{};
};

}}}  // namespace palpate::detail
