// A multifrontal factorisation on the threads of an executor.
#pragma once

#include <palpate/core/detail/change_signal.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/front_tasks.hpp>
#include <palpate/linear/detail/front_work.hpp>

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
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
  void give_array(BigArray array);

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

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/parallel_fronts.ipp>
#endif
