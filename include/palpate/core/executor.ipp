// Definitions of executor.hpp.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/executor.hpp>
#include <palpate/core/platform.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE StartedThreads::StartedThreads(int threads) noexcept
    : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

PALPATE_INLINE void StartedThreads::run(int count, const ExecutorTask& task) const {
  std::atomic<int> next{1};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) task(i);
  };
  std::vector<std::thread> started;
  started.reserve(static_cast<std::size_t>(std::max(0, count - 1)));
  attempt([&] {  // no more threads, or no memory for one: the others do the work
    for (int i = 1; i < count; ++i) started.emplace_back(work);
  });
  if (count > 0) task(0);
  work();
  for (std::thread& thread : started) thread.join();
}

}  // namespace detail

PALPATE_INLINE void SetupThreads::run(int count, const ExecutorTask& task) const {
  const std::uint64_t mode = platform::float_mode();
  [[maybe_unused]] std::mutex mutex;  // without exceptions
  std::exception_ptr first;
  const auto guarded = [&](int i) {
    const std::uint64_t own = platform::float_mode();
    platform::set_float_mode(mode);
#if defined(PALPATE_HAS_EXCEPTIONS)
    try {
      task(i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!first) first = std::current_exception();
    }
#else
    task(i);
#endif
    platform::set_float_mode(own);
  };
  if (executor_ != nullptr)
    run_(executor_, count, guarded);
  else
    detail::StartedThreads(count_).run(count, guarded);
#if defined(PALPATE_HAS_EXCEPTIONS)
  if (first) std::rethrow_exception(first);
#endif
}

}}  // namespace palpate
