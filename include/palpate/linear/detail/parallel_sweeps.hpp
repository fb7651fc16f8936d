// Forward and backward substitution over all fronts on the threads of an executor.
#pragma once

#include <palpate/core/detail/change_signal.hpp>
#include <palpate/core/executor.hpp>
#include <palpate/linear/detail/big_array.hpp>
#include <palpate/linear/detail/front_tasks.hpp>

#include <mutex>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Sweeps over a factor for one right-hand side, for set-up. The result is that of FrontSweeps, to the last bit, for
/// any number of threads: a task stores what its fronts contribute to places outside it, and the front of these places
/// adds the contributions in the order of the fronts.
class ParallelSweeps {
 public:
  /// For the first `count` fronts; `values`, in elimination order, belongs to the caller. Refers to all arguments.
  /// Allocates what the sweeps need.
  ParallelSweeps(const FrontTree& tree, const double* factor, Index count, double* values, const SetupThreads& threads);

  void forward() noexcept;
  void backward() noexcept;

  /// Whether the threads gain more than they cost.
  static bool are_worthwhile(const FrontTree& tree, const SetupThreads& threads) noexcept;

 private:
  /// Contributions of a front to places outside its task, in the order of the places; those before `next` have been
  /// added.
  struct Outside {
    NodeId front = 0;
    Index inside = 0;  ///< rows of the front before them
    Index next = 0;    ///< in contributions_
    Index run = 0;     ///< run of the next row
    NodeId taken = 0;  ///< rows of this run before it
  };

  /// A sweep. `done` is called with the lock.
  struct Sweep {
    void (ParallelSweeps::*task)(Index task, double* local) noexcept;
    void (ParallelSweeps::*done)(Index task) noexcept;
    bool descending;
  };

  void find_outside();
  void run(const Sweep& sweep) noexcept;
  void work(const Sweep& sweep, int thread) noexcept;
  Index next_task(bool descending) noexcept;
  void forward_task(Index task, double* local) noexcept;
  void forward_done(Index task) noexcept;
  void backward_task(Index task, double* local) noexcept;
  void backward_done(Index task) noexcept;
  /// Adds the contributions of tasks begin ... end to the places before `last`.
  void add_contributions(Index begin, Index end, Index last) noexcept;
  template <class Visit>
  void for_each_child(Index task, Visit&& visit) const noexcept;

  const FrontTree& tree_;
  const double* factor_;
  double* values_;
  const SetupThreads& threads_;
  FrontTasks division_;
  IndexedVector<Index> first_below_;  ///< per task: the first task of its subtree
  IndexedVector<Index> outside_of_;   ///< per task: its first entry of outside_
  std::vector<Outside> outside_;
  BigArray contributions_, local_;
  Index local_size_ = 0;  ///< per thread

  std::mutex mutex_;  // of all that follows
  ChangeSignal changed_;
  std::vector<Index> ready_;
  NodeVector waiting_;  ///< per task: children that are not done
  Index left_ = 0;      ///< tasks that are not done
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/parallel_sweeps.ipp>
#endif
