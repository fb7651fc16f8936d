// Clocks, absolute sleeps and real-time privileges of the thread that runs a loop.
#pragma once

#include <palpate/haptic/loop_report.hpp>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <system_error>
#include <thread>

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>
#endif

namespace palpate::inline PALPATE_ABI::detail {

#if defined(__linux__)
inline std::int64_t clock_ns(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
inline std::int64_t wall_ns() noexcept { return clock_ns(CLOCK_MONOTONIC); }
/// Processor time: does not count what other programs do on a busy machine. A system call: 0.2 to 1 us.
inline std::int64_t compute_ns() noexcept { return clock_ns(CLOCK_THREAD_CPUTIME_ID); }
inline void sleep_until_ns(std::int64_t deadline) noexcept {
  const timespec t{static_cast<time_t>(deadline / 1'000'000'000), static_cast<long>(deadline % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

inline RealtimeGrant request_realtime(const LoopOptions& options) {
  RealtimeGrant grant;
  grant.requested = options.real_time && options.paced;
  const auto granted = [&](int error, const char* what) {
    if (error != 0) grant.refusals += std::string(what) + ": " + std::generic_category().message(error) + ". ";
    return error == 0;
  };
  if (options.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (options.cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(options.cpu), &set);
    if (granted(pthread_setaffinity_np(pthread_self(), sizeof set, &set), "pinning")) grant.cpu = options.cpu;
  }
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // this thread's sleeps are not rounded up by the default 50 us
  if (!grant.requested) return grant;
  sched_param priority{};
  priority.sched_priority = 50;
  grant.fifo = granted(pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority), "SCHED_FIFO");
  // Not MCL_FUTURE: with a small limit on locked memory it makes later allocations anywhere in the program fail.
  grant.memory_locked = granted(mlockall(MCL_CURRENT) == 0 ? 0 : errno, "locking memory");
  return grant;
}
#else
inline std::int64_t wall_ns() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}
inline std::int64_t compute_ns() noexcept { return wall_ns(); }
inline void sleep_until_ns(std::int64_t deadline) noexcept {
  using Clock = std::chrono::steady_clock;
  const std::chrono::nanoseconds since_epoch(deadline);
  std::this_thread::sleep_until(Clock::time_point(std::chrono::duration_cast<Clock::duration>(since_epoch)));
}
inline RealtimeGrant request_realtime(const LoopOptions& options) {
  RealtimeGrant grant;
  grant.requested = options.real_time && options.paced;
  if (grant.requested || options.cpu >= 0) grant.refusals = "scheduling, pinning: not supported on this system. ";
  return grant;
}
#endif

inline double measured_clock_cost() noexcept {
  DurationHistogram cost;
  for (int i = 0; i < 1001; ++i) {
    const std::int64_t start = compute_ns();
    cost.record(1e-9 * static_cast<double>(compute_ns() - start));
  }
  return cost.percentile(0.5);
}

}  // namespace palpate::inline PALPATE_ABI::detail
