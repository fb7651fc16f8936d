// Threads of a set-up, and loops divided among them.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <concepts>
#include <functional>

namespace palpate { inline namespace PALPATE_ABI {

/// A task of an executor; the argument is its number.
using ExecutorTask = std::function<void(int)>;

/// What runs the tasks of a set-up: threads started for it, or the pool of the program.
/// - `threads()`: how many tasks run simultaneously, the calling thread included; at least 1.
/// - `run(count, task)`: calls task(0) ... task(count - 1), each exactly once, at least one of them in the calling
///   thread, and returns when all have returned; count <= threads(). Tasks do not throw.
/// A task may wait for tasks that have started, but never for another one to start: an executor with fewer free threads
/// than promised is slower, not wrong. Laws: testing/executor_laws.hpp.
template <class E>
concept Executor = requires(E& executor, int count, const ExecutorTask& task) {
  { executor.threads() } -> std::convertible_to<int>;
  executor.run(count, task);
};

namespace detail {

/// Starts threads for every `run` and joins them at its end, so that no thread is left after the set-up. When the
/// system refuses a thread, the others do its task.
class StartedThreads {
 public:
  /// 0: as many as the machine has.
  explicit StartedThreads(int threads = 0) noexcept;
  int threads() const noexcept { return threads_; }
  void run(int count, const ExecutorTask& task) const;

 private:
  int threads_;
};

}  // namespace detail

/// The threads of a set-up: a number of started ones, or those of an executor, which must outlive it. Results are the
/// same, to the last bit, for any of them.
class SetupThreads {
 public:
  /// Starts `count` - 1 threads while there is work for them; 0: as many as the machine has.
  SetupThreads(int count = 0) noexcept : count_(detail::StartedThreads(count).threads()) {}
  template <Executor E>
  requires(!std::same_as<E, SetupThreads>) SetupThreads(E& executor)
      : count_(executor.threads()),
        executor_(&executor),
        run_([](void* e, int count, const ExecutorTask& task) { static_cast<E*>(e)->run(count, task); }) {}

  int threads() const noexcept { return count_; }
  /// As an executor; tasks may throw, the first exception is thrown again when all have returned. They have the
  /// floating-point mode of the calling thread.
  void run(int count, const ExecutorTask& task) const;

 private:
  int count_;
  void* executor_ = nullptr;
  void (*run_)(void*, int, const ExecutorTask&) = nullptr;
};

static_assert(Executor<detail::StartedThreads>);
static_assert(Executor<SetupThreads>);
static_assert(!Executor<int>);

namespace detail {

/// Calls work(thread, begin, end) for consecutive, equally long ranges of 0 ... count - 1, at least `least` long; for
/// one range in the calling thread. Returns when all have returned.
template <class Work>
void thread_ranges(Index count, Index least, const SetupThreads& threads, Work&& work) {
  const auto parts = static_cast<int>(std::clamp<Index>(count / least, 1, threads.threads()));
  if (parts == 1) return work(0, Index{0}, count);
  threads.run(parts, [&](int i) { work(i, count * i / parts, count * (i + 1) / parts); });
}

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/core/executor.ipp>
#endif
