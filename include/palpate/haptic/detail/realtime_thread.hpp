// Real-time privileges of the thread that runs a loop.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/loop_options.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// What was requested from the operating system and what it granted. Memory stays locked after the loop: unlocking
/// could undo a lock of the caller.
struct RealtimeGrant {
  bool requested = false;
  bool fifo = false;           ///< SCHED_FIFO, priority 50; on Windows time-critical priority
  bool memory_locked = false;  ///< the pages mapped at the start
  int cpu = -1;                ///< the processor to which the thread is pinned
  std::string refusals;        ///< one sentence per refusal, with the system's reason
};

namespace detail {

/// Requests for this thread what the options specify. Refusals are in the grant.
RealtimeGrant request_realtime(const LoopOptions& options);

}  // namespace detail

inline RealtimeGrant detail::request_realtime(const LoopOptions& options) {
  RealtimeGrant grant;
  grant.requested = options.real_time && options.paced;
  const auto granted = [&](int error, const char* what) {
    if (error != 0) grant.refusals += std::string(what) + ": " + platform::error_text(error) + ". ";
    return error == 0;
  };
  if (options.cpu >= 0 && granted(platform::pin_this_thread(options.cpu), "pinning")) grant.cpu = options.cpu;
  platform::ask_for_exact_sleeps();
  if (!grant.requested) return grant;
  grant.fifo = granted(platform::ask_for_realtime_scheduling(), platform::realtime_scheduling);
  grant.memory_locked = granted(platform::lock_memory(), "locking memory");
  return grant;
}

}}  // namespace palpate

