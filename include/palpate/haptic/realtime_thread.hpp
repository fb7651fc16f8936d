// Real-time privileges of the thread that runs a loop.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/loop_options.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// What was asked of the operating system and what it gave. Memory stays locked after the loop: unlocking could undo a
/// lock of the caller's own.
struct RealtimeGrant {
  bool requested = false;
  bool fifo = false;           ///< SCHED_FIFO, priority 50; on Windows time-critical priority
  bool memory_locked = false;  ///< the pages mapped at the start
  int cpu = -1;                ///< pinned to this one
  std::string refusals;        ///< one sentence per refusal, with the system's reason
};

namespace detail {

/// Asks for what the options say, for this thread. What is refused is in the grant.
inline RealtimeGrant request_realtime(const LoopOptions& options) {
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

}  // namespace detail

}}  // namespace palpate
