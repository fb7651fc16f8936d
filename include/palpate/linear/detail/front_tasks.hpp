// Division of a factorisation into tasks for several threads.
#pragma once

#include <palpate/linear/detail/front_tree.hpp>

#include <algorithm>
#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A small subtree, or one front above the subtrees: fronts `begin` ... `end`, children before parents.
struct FrontTask {
  Index begin = 0, end = 0;
  Index workspace = 0;  ///< of the updates inside [doubles]
  Index update = 0;     ///< size of the update of its last front [doubles]
  NodeId parent = -1;   ///< task that takes the update
  NodeId children = 0;  ///< tasks whose updates it takes
};

/// The division depends only on the tree, not on the number of threads.
struct FrontTasks {
  IndexedVector<FrontTask> tasks;  ///< children before parents
  NodeVector task_of;              ///< per front: the task that it is the last one of, -1 inside a task
  IndexedVector<Index> offset;     ///< per front: its update in the workspace of its task
  Index workspace = 0;             ///< largest [doubles]
  Index live = 0;     ///< largest total size of simultaneously stored updates of tasks, one after the other [doubles]
  Index subtree = 0;  ///< largest update of a subtree [doubles]

  /// Room for the updates of tasks that are done before earlier ones [doubles].
  Index ahead(int threads) const noexcept { return 4 * (threads - 1) * subtree; }
};

/// Places the updates of fronts begin ... end in a workspace as two stacks that grow towards each other, one for odd
/// and one for even depth. So the update of a front never overlaps those of its children, which are freed before.
/// Updates of fronts whose parent is not among them are not placed. Writes `offset` [doubles] of these fronts; returns
/// the size of the workspace.
inline Index stack_updates(const IndexedVector<Front>& fronts, Index begin, Index end, IndexedVector<Index>& offset) {
  IndexedVector<char> odd(end - begin, 0);
  for (Index f = end - 1; f >= begin; --f)
    if (const Index p = fronts[f].parent; p >= 0 && p < end) odd[f - begin] = odd[p - begin] == 0 ? 1 : 0;
  std::array<Index, 2> top{0, 0};
  Index size = 0;
  const auto size_of = [&](Index f) {
    return fronts[f].parent >= 0 && fronts[f].parent < end ? fronts[f].update_panels().size() : 0;
  };
  for (Index f = begin; f < end; ++f) {
    const bool is_odd = odd[f - begin] != 0;
    Index& mine = top[is_odd ? 1 : 0];
    mine += size_of(f);
    offset[f] = is_odd ? -mine : mine - size_of(f);
    size = std::max(size, top[0] + top[1]);
    for (NodeId c = fronts[f].first_child; c >= 0; c = fronts[c].next_sibling)
      if (c >= begin) top[is_odd ? 0 : 1] -= size_of(c);
  }
  for (Index f = begin; f < end; ++f)
    if (odd[f - begin] != 0) offset[f] += size;
  return size;
}

/// Divides the first `count` fronts.
inline FrontTasks divide_fronts(const FrontTree& tree, Index count) {
  constexpr double tasks = 200.0, least_flops = 1e7;  // a task should take much longer than handing it out
  const IndexedVector<Front>& fronts = tree.fronts;
  IndexedVector<double> flops(count, 0.0);
  IndexedVector<Index> begin(count);
  for (Index f = 0; f < count; ++f) {
    flops[f] += fronts[f].flops();
    const NodeId first = fronts[f].first_child;
    begin[f] = first >= 0 ? begin[first] : f;
    if (const NodeId p = fronts[f].parent; p >= 0 && p < count) flops[p] += flops[f];
  }
  const double most = std::max(tree.flops / tasks, least_flops);
  FrontTasks d;
  d.offset.assign(count, 0);
  d.task_of.assign(count, -1);
  Index live = 0;
  for (Index f = 0; f < count; ++f) {
    const NodeId p = fronts[f].parent;
    const bool top = flops[f] > most;
    if (!top && p >= 0 && p < count && flops[p] <= most) continue;  // inside a subtree
    FrontTask t{.begin = top ? f : begin[f], .end = f + 1};
    t.workspace = stack_updates(fronts, t.begin, t.end, d.offset);
    t.update = fronts[f].update_panels().size();
    live += t.update;
    d.live = std::max(d.live, live);
    d.task_of[f] = static_cast<NodeId>(d.tasks.size());
    if (top)
      for (NodeId c = fronts[f].first_child; c >= 0; c = fronts[c].next_sibling) {
        FrontTask& child = d.tasks[d.task_of[c]];
        child.parent = d.task_of[f];
        ++t.children;
        live -= child.update;
      }
    else
      d.subtree = std::max(d.subtree, t.update);
    d.workspace = std::max(d.workspace, t.workspace);
    d.tasks.push_back(t);
  }
  return d;
}

}}}  // namespace palpate::detail
