// Real-time privileges of the thread that runs a loop.
#pragma once

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/realtime_thread.ipp>
#endif
