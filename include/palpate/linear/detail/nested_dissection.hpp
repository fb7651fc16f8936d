// Elimination order by nested dissection (George 1973; Lipton, Rose and Tarjan 1979).
#pragma once

#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/level_order.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/linear/detail/separator.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

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

/// What the threads of a dissection share: every thread changes only the entries of its parts. The neighbours of a part
/// outside it are in separators that were found before.
struct Dissection {
  static constexpr NodeId later = -2, gone = -3;  // labels of nodes in separators and in leaves
  const NodeGraph& graph;
  PartLists lists{};
  NodeVector order{};

  /// Lists the nodes that are not kept, sorted along the axes if there are coordinates.
  explicit Dissection(const NodeGraph& of) : graph(of) {
    lists.graph = &graph;
    lists.place.assign(graph.nodes(), NodePlace());
    lists.side.assign(graph.nodes(), side_first);
    std::vector<std::pair<double, NodeId>> keys;
    for (int axis = 0; axis < dissection_axes; ++axis) {
      keys.clear();
      for (Index v = 0; v < graph.nodes(); ++v)
        if (graph.kept[v] == 0)
          keys.emplace_back(graph.positions.empty() ? 0.0 : graph.positions[static_cast<std::size_t>(v)][axis],
                            static_cast<NodeId>(v));
      if (!graph.positions.empty()) std::sort(keys.begin(), keys.end());
      NodeVector& sorted = lists.sorted[static_cast<std::size_t>(axis)];
      for (const auto& [key, v] : keys) {
        sorted.push_back(v);
        lists.place[v].label = 0;
      }
    }
    order.resize(lists.sorted[0].size());
  }
};

/// Bisects parts until they are small: one thread with its workspace.
class PartBisection {
 public:
  static constexpr Index leaf_nodes = 64;

  explicit PartBisection(Dissection& all) : all_(all), lists_(all.lists), finder_(all.lists), leaf_(all.graph) {
    if (all.graph.positions.empty()) levels_.emplace_back(lists_);
  }

  /// Orders the separator of a part and returns the two sides, or orders all of it and returns empty ones.
  std::array<Part, 2> bisect(const Part& part) {
    if (part.size() <= leaf_nodes) return finish(part);
    if (!levels_.empty()) levels_.front().sort(part);
    const std::array<Index, 3> sizes = finder_.cut(part);
    if (sizes[0] == 0 || sizes[1] == 0 || 2 * sizes[2] > part.size()) return finish(part);
    for (NodeVector& sorted : lists_.sorted) split(sorted, part, sizes);
    const Part first{part.begin, part.begin + sizes[0], part.label};
    const Part second{first.end, first.end + sizes[1], static_cast<NodeId>(first.end)};
    for (Index i = second.begin; i < second.end; ++i) lists_.place[lists_.sorted[0][i]].label = second.label;
    for (Index i = second.end; i < part.end; ++i) {
      all_.order[i] = lists_.sorted[0][i];
      lists_.place[all_.order[i]].label = Dissection::later;
    }
    return {first, second};
  }
  void dissect(const Part& part) {
    for (const Part& side : bisect(part))
      if (side.size() > 0) dissect(side);
  }

 private:
  /// Moves the nodes of the first side to the front of a list and the separator to its end.
  void split(NodeVector& sorted, const Part& part, const std::array<Index, 3>& sizes) {
    std::array<Index, 3> to{0, sizes[0], sizes[0] + sizes[1]};
    buffer_.resize(part.size());
    for (Index i = part.begin; i < part.end; ++i)
      buffer_[to[static_cast<std::size_t>(lists_.side[sorted[i]])]++] = sorted[i];
    std::copy(buffer_.begin(), buffer_.end(), sorted.begin() + part.begin);
  }

  std::array<Part, 2> finish(const Part& part) {
    NodeVector& order = all_.order;
    for (Index i = part.begin; i < part.end; ++i) order[i] = lists_.sorted[0][i];
    if (part.size() <= LeafOrder::max_nodes)
      leaf_.order(order.data() + part.begin, part.size(),
                  [&](NodeId u) { return lists_.place[u].label == Dissection::later || all_.graph.kept[u] != 0; });
    for (Index i = part.begin; i < part.end; ++i) lists_.place[order[i]].label = Dissection::gone;
    return {};
  }

  Dissection& all_;
  PartLists& lists_;
  SeparatorFinder finder_;
  LeafOrder leaf_;
  std::vector<LevelOrder> levels_;  // empty when there are coordinates
  NodeVector buffer_;
};

/// Distributes the parts of a dissection among threads.
class PartQueue {
 public:
  PartQueue(Dissection& all, const SetupLimits& limits) : all_(all), limits_(limits) {
    if (all.order.size() > 0) parts_.push_back({0, all.order.size(), 0});
  }

  void run() {
    limits_.advance("factorisation", 0.0);
    const int threads = all_.order.size() > 2 * worth_sharing ? limits_.threads.threads() : 1;
    if (threads > 1)
      limits_.threads.run(threads, [this](int) { work(); });
    else
      work();
  }

 private:
  static constexpr Index worth_sharing = 2000;

  void work() {
    // A thread that fails stops the others.
    struct Stop {
      PartQueue& queue;
      bool finished = false;
      ~Stop() {
        const std::scoped_lock lock(queue.mutex_);
        if (!finished) queue.stopped_ = true;
        queue.changed_.notify_all();
      }
    } stop{*this};
    PartBisection bisection(all_);
    Part part;
    while (pop(part)) {
      if (part.size() > worth_sharing)
        give(bisection.bisect(part));
      else
        bisection.dissect(part), give({});
    }
    stop.finished = true;
  }

  /// The part that was added last, so that the first thread goes on with what is in its cache. False at the end.
  bool pop(Part& part) {
    std::unique_lock lock(mutex_);
    const auto ready = [&] { return stopped_ || !parts_.empty() || in_work_ == 0; };
    do {
      if (std::this_thread::get_id() != caller_) continue;
      lock.unlock();
      limits_.advance("factorisation", 0.0);
      lock.lock();
    } while (!changed_.wait_for(lock, std::chrono::milliseconds(20), ready));
    if (stopped_ || parts_.empty()) return false;
    part = parts_.back();
    parts_.pop_back();
    ++in_work_;
    return true;
  }
  void give(const std::array<Part, 2>& sides) {
    const std::scoped_lock lock(mutex_);
    for (const Part& side : sides)
      if (side.size() > 0) parts_.push_back(side);
    --in_work_;
    changed_.notify_all();
  }

  Dissection& all_;
  const SetupLimits& limits_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  std::vector<Part> parts_;
  int in_work_ = 0;
  bool stopped_ = false;
};

/// The nodes of a graph in elimination order, kept ones last. Uses coordinates if there are any. The order is the same
/// for any number of threads. O(edges log nodes). Throws cancelled.
inline NodeVector nested_dissection(const NodeGraph& graph, const SetupLimits& limits = {}) {
  Dissection all(graph);
  PartQueue(all, limits).run();
  for (Index v = 0; v < graph.nodes(); ++v)
    if (graph.kept[v] != 0) all.order.push_back(static_cast<NodeId>(v));
  return std::move(all.order);
}

}}}  // namespace palpate::detail
