// Definitions of nested_dissection.hpp.
#pragma once

#include <palpate/linear/detail/leaf_order.hpp>
#include <palpate/linear/detail/level_order.hpp>
#include <palpate/linear/detail/nested_dissection.hpp>
#include <palpate/linear/detail/separator.hpp>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

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
    while (take(part)) {
      if (part.size() > worth_sharing)
        give(bisection.bisect(part));
      else
        bisection.dissect(part), give({});
    }
    stop.finished = true;
  }

  /// The part that was added last, so that the first thread goes on with what is in its cache. False at the end.
  bool take(Part& part) {
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

}  // namespace detail

PALPATE_INLINE detail::NodeVector nested_dissection(const NodeGraph& graph, const SetupLimits& limits) {
  detail::Dissection all(graph);
  detail::PartQueue(all, limits).run();
  for (Index v = 0; v < graph.nodes(); ++v)
    if (graph.kept[v] != 0) all.order.push_back(static_cast<NodeId>(v));
  return std::move(all.order);
}

}}  // namespace palpate
