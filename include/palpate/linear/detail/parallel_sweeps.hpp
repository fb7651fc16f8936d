// Forward and backward substitution over all fronts on the threads of an executor.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/detail/change_signal.hpp>
#include <palpate/core/executor.hpp>
#include <palpate/linear/detail/big_array.hpp>
#include <palpate/linear/detail/front_tasks.hpp>
#include <palpate/linear/detail/one_front.hpp>

#include <algorithm>
#include <chrono>
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
  static bool are_worthwhile(const FrontTree& tree, const SetupThreads& threads) noexcept {
    constexpr Index worth_threads = Index{1} << 20;  // [doubles], 8 MB; a thread starts in the time of reading 1 MB
    return threads.threads() > 1 && tree.factor_size > worth_threads;
  }

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
  void run(const Sweep& sweep) noexcept {
    attempt([&] { threads_.run(threads_.threads(), [&](int thread) { work(sweep, thread); }); });
    work(sweep, 0);
  }
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

inline ParallelSweeps::ParallelSweeps(const FrontTree& tree, const double* factor, Index count, double* values,
                                      const SetupThreads& threads)
    : tree_(tree),
      factor_(factor),
      values_(values),
      threads_(threads),
      division_(divide_fronts(tree, count)),
      first_below_(division_.tasks.size()),
      outside_of_(division_.tasks.size() + 1),
      local_size_(LowerPanels::padded(tree.largest_front) + LowerPanels::alignment),
      waiting_(division_.tasks.size()) {
  local_ = BigArray(local_size_ * threads.threads());
  ready_.reserve(static_cast<std::size_t>(division_.tasks.size()));
  for (Index t = 0; t < division_.tasks.size(); ++t) {
    first_below_[t] = t;
    for_each_child(t, [&](Index child) { first_below_[t] = std::min(first_below_[t], first_below_[child]); });
  }
  find_outside();
}

inline void ParallelSweeps::find_outside() {
  Index size = 0;
  for (Index t = 0; t < division_.tasks.size(); ++t) {
    outside_of_[t] = static_cast<Index>(outside_.size());
    const FrontTask& task = division_.tasks[t];
    const Front& top = tree_.fronts[task.end - 1];
    const Index last = top.first + top.pivots;
    for (Index f = task.begin; f < task.end; ++f) {
      const Front& front = tree_.fronts[f];
      Outside o{.front = static_cast<NodeId>(f), .next = size, .run = front.run_begin};
      while (o.run < front.run_end && tree_.runs[o.run].first + tree_.runs[o.run].count <= last)
        o.inside += tree_.runs[o.run++].count;
      if (o.run == front.run_end) continue;
      o.taken = static_cast<NodeId>(std::max(Index{0}, last - tree_.runs[o.run].first));
      o.inside += o.taken;
      size += front.rows - o.inside;
      outside_.push_back(o);
    }
  }
  outside_of_[division_.tasks.size()] = static_cast<Index>(outside_.size());
  contributions_ = BigArray(size);
}

inline void ParallelSweeps::forward() noexcept {
  left_ = division_.tasks.size();
  for (Index t = left_ - 1; t >= 0; --t) {
    waiting_[t] = division_.tasks[t].children;
    if (waiting_[t] == 0) ready_.push_back(t);
  }
  run({&ParallelSweeps::forward_task, &ParallelSweeps::forward_done, false});
  add_contributions(0, division_.tasks.size(), tree_.place_of_dof.size());  // to the kept dofs
}

inline void ParallelSweeps::backward() noexcept {
  left_ = division_.tasks.size();
  for (Index t = 0; t < left_; ++t)
    if (division_.tasks[t].parent < 0) ready_.push_back(t);
  run({&ParallelSweeps::backward_task, &ParallelSweeps::backward_done, true});
}

inline void ParallelSweeps::work(const Sweep& sweep, int thread) noexcept {
  std::unique_lock lock(mutex_);
  while (left_ > 0) {
    if (ready_.empty()) {  // another thread is at work
      changed_.wait_for(lock, std::chrono::milliseconds(20));
      continue;
    }
    const Index task = next_task(sweep.descending);
    lock.unlock();
    (this->*sweep.task)(task, local_.data() + thread * local_size_);
    lock.lock();
    (this->*sweep.done)(task);
    --left_;
    changed_.notify_all();
  }
}

/// The first ready task of the order of the sweep, so that tasks of neighbouring fronts follow each other.
inline Index ParallelSweeps::next_task(bool descending) noexcept {
  const auto next =
      descending ? std::max_element(ready_.begin(), ready_.end()) : std::min_element(ready_.begin(), ready_.end());
  const Index task = *next;
  *next = ready_.back();
  ready_.pop_back();
  return task;
}

inline void ParallelSweeps::forward_task(Index t, double* local) noexcept {
  const FrontTask& task = division_.tasks[t];
  const Front& top = tree_.fronts[task.end - 1];
  if (task.children > 0) add_contributions(first_below_[t], t, top.first + top.pivots);
  auto outside = outside_.begin() + outside_of_[t];
  const auto end = outside_.begin() + outside_of_[t + 1];
  for (Index f = task.begin; f < task.end; ++f) {
    const Front& front = tree_.fronts[f];
    forward_pivots(front, factor_, values_, local);
    if (outside == end || outside->front != f) {
      add_rows(tree_, front, front.rows, local + front.pivots, values_);
    } else {
      add_rows(tree_, front, outside->inside, local + front.pivots, values_);
      std::copy(local + front.pivots + outside->inside, local + front.size(), contributions_.data() + outside->next);
      ++outside;
    }
  }
}

inline void ParallelSweeps::forward_done(Index t) noexcept {
  const NodeId parent = division_.tasks[t].parent;
  if (parent >= 0 && --waiting_[parent] == 0) ready_.push_back(parent);
}

inline void ParallelSweeps::backward_task(Index t, double* local) noexcept {
  const FrontTask& task = division_.tasks[t];
  for (Index f = task.end - 1; f >= task.begin; --f) backward_one(tree_, tree_.fronts[f], factor_, values_, local);
}

inline void ParallelSweeps::backward_done(Index t) noexcept {
  for_each_child(t, [&](Index child) { ready_.push_back(child); });
}

inline void ParallelSweeps::add_contributions(Index begin, Index end, Index last) noexcept {
  for (Index i = outside_of_[begin]; i < outside_of_[end]; ++i) {
    Outside& o = outside_[static_cast<std::size_t>(i)];
    for (const Index runs = tree_.fronts[o.front].run_end; o.run < runs;) {
      const Run& run = tree_.runs[o.run];
      const Index first = run.first + o.taken, count = std::min<Index>(run.first + run.count, last) - first;
      if (count <= 0) break;
      for (Index k = 0; k < count; ++k) values_[first + k] += contributions_.data()[o.next + k];
      o.next += count;
      o.taken += static_cast<NodeId>(count);
      if (o.taken < run.count) break;
      ++o.run;
      o.taken = 0;
    }
  }
}

template <class Visit>
void ParallelSweeps::for_each_child(Index t, Visit&& visit) const noexcept {
  const FrontTask& task = division_.tasks[t];
  if (task.children == 0) return;
  for (NodeId c = tree_.fronts[task.begin].first_child; c >= 0; c = tree_.fronts[c].next_sibling)
    visit(Index{division_.task_of[c]});
}

}}}  // namespace palpate::detail
