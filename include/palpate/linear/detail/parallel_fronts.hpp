// A multifrontal factorisation on the threads of an executor.
#pragma once

#include <palpate/core/detail/change_signal.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/front_tasks.hpp>
#include <palpate/linear/detail/front_work.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Eliminates the first `count` fronts of a tree. A thread takes the first task whose children are done; without one,
/// it shares the work on a large front of another thread. Tasks that are done before earlier ones must leave room for
/// these: see FrontTasks::ahead. The values of the factor are the same, to the last bit, for any number of threads.
class ParallelFronts {
 public:
  ParallelFronts(FrontSystem& system, Index count, Index pack_size, const SetupLimits& limits);

  /// Throws cancelled, or std::bad_alloc. Pivots are not checked.
  void run();
  /// Afterwards: assembles a front whose children are eliminated; returns the thread's workspace.
  FrontWork& assemble(const Front& front, double* columns);

  /// Doubles that it allocates beside the factor and the fronts' rows.
  static double peak_doubles(const FrontTree& tree, Index count, Index pack_size, int threads);

 private:
  struct Worker {
    Worker(const FrontTree& tree, Index pack_size, Index size) : front(tree, pack_size), workspace(size) {}
    FrontWork front;
    BigArray workspace;
  };
  /// Pieces of the work on one front.
  struct Shared {
    Index count;
    void* piece;
    void (*call)(void*, Index);
    std::atomic<Index> next{0};
    int helpers = 0;
  };
  class Team;

  void work(int thread) noexcept;
  void eliminate(Index task, Worker& worker);
  void finish(Index task);
  Index next_task();
  Shared* next_shared() noexcept;
  void take_pieces(Shared& shared) noexcept;
  /// Reports progress now and then, in the thread of the set-up; stops all threads when cancelled.
  void report();
  void stop(std::exception_ptr reason) noexcept;
  BigArray take_array(Index size);
  void give_array(BigArray array) {
    if (array.size() > 0) unused_.push_back(std::move(array));
  }

  FrontSystem& system_;
  Index pack_size_;
  const SetupLimits& limits_;
  FrontTasks division_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<double> flops_{0.0};
  std::chrono::steady_clock::time_point reported_ = std::chrono::steady_clock::now();
  double reported_fraction_ = 0.0;
  std::atomic<bool> stopped_{false};

  std::mutex mutex_;  // of all that follows
  ChangeSignal changed_;
  std::exception_ptr problem_;
  std::vector<Index> ready_;       // a heap, first task on top
  IndexedVector<NodeId> waiting_;  // per task: children that are not done
  IndexedVector<char> done_;
  IndexedVector<char> is_ahead_;
  IndexedVector<BigArray> updates_;  // per task
  std::vector<BigArray> unused_;
  std::vector<Shared*> shared_;
  Index first_ = 0;                           // task that is not done
  Index ahead_ = 0, most_ahead_ = 0;          // [doubles]
  Index allocated_ = 0, most_allocated_ = 0;  // of updates [doubles]
};

/// Not more than the work is worth: starting a thread takes longer than some ten million operations.
inline int useful_threads(const FrontTree& tree, const FrontTasks& division, int available) noexcept {
  constexpr double flops_of_thread = 1e8;
  const double most = std::min(tree.flops / flops_of_thread, static_cast<double>(division.tasks.size()));
  return static_cast<int>(std::clamp(most, 1.0, static_cast<double>(std::max(1, available))));
}

/// Lets threads without a task share the work on a front.
class ParallelFronts::Team final : public FrontTeam {
 public:
  explicit Team(ParallelFronts& all) : all_(all) {}

 private:
  void run(Index count, void* piece, void (*call)(void*, Index)) noexcept override {
    Shared shared{count, piece, call};
    const bool alone = count < 2 || all_.workers_.size() < 2;
    if (!alone) {
      const std::scoped_lock lock(all_.mutex_);
      all_.shared_.push_back(&shared);
      all_.changed_.notify_all();
    }
    all_.take_pieces(shared);
    if (alone) return;
    std::unique_lock lock(all_.mutex_);
    std::erase(all_.shared_, &shared);
    all_.changed_.wait(lock, [&] { return shared.helpers == 0; });
  }

  ParallelFronts& all_;
};

inline ParallelFronts::ParallelFronts(FrontSystem& system, Index count, Index pack_size, const SetupLimits& limits)
    : system_(system),
      pack_size_(pack_size),
      limits_(limits),
      division_(divide_fronts(system.tree, count)),
      waiting_(division_.tasks.size()),
      done_(division_.tasks.size(), 0),
      is_ahead_(division_.tasks.size(), 0) {
  const Index tasks = division_.tasks.size();
  const int threads = useful_threads(system.tree, division_, limits.threads.threads());
  workers_.resize(static_cast<std::size_t>(threads));
  updates_.resize(tasks);
  // so that nothing is allocated where an exception could not be passed on
  ready_.reserve(static_cast<std::size_t>(tasks));
  unused_.reserve(static_cast<std::size_t>(tasks));
  shared_.reserve(workers_.size());
  for (Index t = tasks - 1; t >= 0; --t) {
    waiting_[t] = division_.tasks[t].children;
    if (waiting_[t] == 0) ready_.push_back(t);
  }
  std::make_heap(ready_.begin(), ready_.end(), std::greater<>());
  most_ahead_ = division_.ahead(threads);
  most_allocated_ = division_.live + most_ahead_;
}

inline double ParallelFronts::peak_doubles(const FrontTree& tree, Index count, Index pack_size, int threads) {
  const FrontTasks division = divide_fronts(tree, count);
  threads = useful_threads(tree, division, threads);
  const double of_thread = static_cast<double>(division.workspace + pack_size + tree.place_of_dof.size() / 2);
  return static_cast<double>(division.live + division.ahead(threads)) + threads * of_thread;
}

inline void ParallelFronts::run() {
  const auto threads = static_cast<int>(workers_.size());
  if (threads > 1)
    limits_.threads.run(threads, [this](int thread) { work(thread); });
  else
    work(0);
#if defined(PALPATE_HAS_EXCEPTIONS)
  if (problem_) std::rethrow_exception(problem_);
#endif
}

inline FrontWork& ParallelFronts::assemble(const Front& front, double* columns) {
  for (std::unique_ptr<Worker>& worker : workers_) {
    if (!worker) continue;
    worker->workspace = BigArray();
    worker->front.assemble(system_, front, columns, nullptr);
    return worker->front;
  }
  workers_.front() = std::make_unique<Worker>(system_.tree, pack_size_, 0);
  workers_.front()->front.assemble(system_, front, columns, nullptr);
  return workers_.front()->front;
}

inline void ParallelFronts::work(int thread) noexcept {
  std::unique_lock lock(mutex_);
  while (!stopped_ && first_ < division_.tasks.size()) {
    if (const Index task = next_task(); task >= 0) {
      lock.unlock();
#if defined(PALPATE_HAS_EXCEPTIONS)
      try {
#endif
        std::unique_ptr<Worker>& worker = workers_[static_cast<std::size_t>(thread)];
        if (!worker) worker = std::make_unique<Worker>(system_.tree, pack_size_, division_.workspace);
        eliminate(task, *worker);
#if defined(PALPATE_HAS_EXCEPTIONS)
      } catch (...) {
        stop(std::current_exception());
      }
#endif
      lock.lock();
      if (!stopped_) finish(task);
      changed_.notify_all();
    } else if (Shared* const shared = next_shared()) {
      ++shared->helpers;
      lock.unlock();
      take_pieces(*shared);
      lock.lock();
      if (--shared->helpers == 0) changed_.notify_all();
    } else {
      changed_.wait_for(lock, std::chrono::milliseconds(20));
      lock.unlock();
      report();
      lock.lock();
    }
  }
}

inline void ParallelFronts::eliminate(Index t, Worker& worker) {
  constexpr double shared_flops = 3e7;  // of a front that is large enough to be shared
  const FrontTask& task = division_.tasks[t];
  const Index last = task.end - 1;
  {
    const std::scoped_lock lock(mutex_);
    updates_[t] = take_array(task.update);
  }
  Team team(*this);
  for (Index f = task.begin; f < task.end && !stopped_; ++f) {
    const double flops = system_.tree.fronts[f].flops();
    system_.updates[f] = f == last ? updates_[t].data() : worker.workspace.data() + division_.offset[f];
    worker.front.eliminate(system_, f, flops > shared_flops ? &team : nullptr);
    flops_.fetch_add(flops, std::memory_order_relaxed);
    report();
  }
}

inline void ParallelFronts::finish(Index t) {
  const FrontTask& task = division_.tasks[t];
  if (task.children > 0)
    for (NodeId c = system_.tree.fronts[task.begin].first_child; c >= 0; c = system_.tree.fronts[c].next_sibling)
      give_array(std::move(updates_[division_.task_of[c]]));
  done_[t] = 1;
  while (first_ < done_.size() && done_[first_] != 0) {
    if (is_ahead_[first_] != 0) ahead_ -= division_.tasks[first_].update;
    ++first_;
  }
  if (task.parent >= 0 && --waiting_[task.parent] == 0) {
    ready_.push_back(task.parent);
    std::push_heap(ready_.begin(), ready_.end(), std::greater<>());
  }
}

/// The first ready task, unless there is no room for it yet; -1 without one.
inline Index ParallelFronts::next_task() {
  if (ready_.empty()) return -1;
  const Index t = ready_.front(), size = division_.tasks[t].update;
  if (t > first_) {
    if (ahead_ + size > most_ahead_) return -1;
    is_ahead_[t] = 1;
    ahead_ += size;
  }
  std::pop_heap(ready_.begin(), ready_.end(), std::greater<>());
  ready_.pop_back();
  return t;
}

inline ParallelFronts::Shared* ParallelFronts::next_shared() noexcept {
  for (Shared* const s : shared_)
    if (s->next.load(std::memory_order_relaxed) < s->count) return s;
  return nullptr;
}

inline void ParallelFronts::take_pieces(Shared& shared) noexcept {
  for (Index i = shared.next++; i < shared.count && !stopped_; i = shared.next++) {
    shared.call(shared.piece, i);
    report();
  }
}

inline void ParallelFronts::report() {
  constexpr std::chrono::milliseconds between{10};
  if (std::this_thread::get_id() != caller_ || !limits_.progress || stopped_) return;
  const double fraction = std::min(1.0, flops_.load(std::memory_order_relaxed) / system_.tree.flops);
  const auto now = std::chrono::steady_clock::now();
  if (fraction - reported_fraction_ < 0.01 && now - reported_ < between) return;
  reported_ = now;
  reported_fraction_ = fraction;
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
#endif
    limits_.advance("factorisation", fraction);
#if defined(PALPATE_HAS_EXCEPTIONS)
  } catch (...) {
    stop(std::current_exception());
  }
#endif
}

inline void ParallelFronts::stop(std::exception_ptr reason) noexcept {
  const std::scoped_lock lock(mutex_);
  if (!problem_) problem_ = std::move(reason);
  stopped_ = true;
  changed_.notify_all();
}

/// An unused array, if one is large enough and not much too large, or a new one.
inline BigArray ParallelFronts::take_array(Index size) {
  auto best = unused_.end();
  for (auto a = unused_.begin(); a != unused_.end(); ++a)
    if (a->size() >= size && 4 * a->size() <= 5 * size && (best == unused_.end() || a->size() < best->size())) best = a;
  if (best != unused_.end()) {
    BigArray found = std::move(*best);
    unused_.erase(best);
    return found;
  }
  while (!unused_.empty() && allocated_ + size > most_allocated_) {
    allocated_ -= unused_.back().size();
    unused_.pop_back();
  }
  allocated_ += size;
  return BigArray(size);
}

}}}  // namespace palpate::detail
