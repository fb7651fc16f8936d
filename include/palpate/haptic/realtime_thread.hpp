// Real-time privileges of the thread that runs a loop, and what its clock costs.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/loop_report.hpp>

namespace palpate::inline PALPATE_ABI::detail {

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

inline double measured_clock_cost() noexcept {
  DurationHistogram cost;
  for (int i = 0; i < 1001; ++i) {
    const std::int64_t start = platform::compute_ns();
    cost.record(1e-9 * static_cast<double>(platform::compute_ns() - start));
  }
  return cost.percentile(0.5);
}

}  // namespace palpate::inline PALPATE_ABI::detail
