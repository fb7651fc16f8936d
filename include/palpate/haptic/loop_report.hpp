// What a haptic loop has to say afterwards.
#pragma once

#include <palpate/core/status.hpp>
#include <palpate/haptic/detail/realtime_thread.hpp>
#include <palpate/haptic/duration_histogram.hpp>

#include <iosfwd>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// What one device of a loop was given.
struct DeviceReport {
  double peak_force = 0.0;  ///< [N] longest
  StatusCounters status;    ///< of its tool and of itself, one count per flag and tick
};

struct LoopReport {
  double rate = 0.0;     ///< [1/s] asked for
  double elapsed = 0.0;  ///< [s] wall time of the loop
  bool paced = true;
  bool cancelled = false;  ///< ended by the progress callback, or stopped before its duration was over
  std::uint64_t ticks = 0;
  std::uint64_t missed_deadlines = 0;  ///< periods without a tick: the one before woke or ended too late
  DurationHistogram compute;           ///< servo.tick: processor time of the thread on Linux, wall time elsewhere
  DurationHistogram lateness;          ///< from deadline to wake-up, wall time; empty unless paced
  double clock_cost = 0.0;             ///< [s] median of two clock readings in a row: contained in every compute time
  double peak_force = 0.0;             ///< [N] longest force the servo gave
  StatusCounters status;               ///< of servo and devices, one count per flag and tick
  std::vector<DeviceReport> devices;   ///< the same, one per device
  RealtimeGrant real_time;
};

/// A compact table: what was run, percentiles, peak force, status counts, what real time was granted.
std::ostream& operator<<(std::ostream& out, const LoopReport& r);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/loop_report.ipp>
#endif
