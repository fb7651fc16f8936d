// Definitions of realtime_thread.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/detail/realtime_thread.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE RealtimeGrant detail::request_realtime(const LoopOptions& options) {
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
