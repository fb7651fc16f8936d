// Division of a factorisation into tasks for several threads.
#pragma once

#include <palpate/linear/detail/front_tree.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Places the updates of fronts begin ... end in a workspace as two stacks that grow towards each other, one for odd
/// and one for even depth. So the update of a front never overlaps those of its children, which are freed before.
/// Updates of fronts whose parent is not among them are not placed. Writes `offset` [doubles] of these fronts; returns
/// the size of the workspace.
Index stack_updates(const IndexedVector<Front>& fronts, Index begin, Index end, IndexedVector<Index>& offset);

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

/// Divides the first `count` fronts.
FrontTasks divide_fronts(const FrontTree& tree, Index count);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/front_tasks.ipp>
#endif
