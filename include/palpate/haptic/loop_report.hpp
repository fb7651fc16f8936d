// Report of a haptic loop.
#pragma once

#include <palpate/core/status.hpp>
#include <palpate/haptic/detail/realtime_thread.hpp>
#include <palpate/haptic/duration_histogram.hpp>

#include <iosfwd>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Report of one device of a loop.
struct DeviceReport {
  double peak_force = 0.0;  ///< [N] longest
  StatusCounters status;    ///< of its tool and of itself, one count per flag and tick
};

struct LoopReport {
  double rate = 0.0;     ///< [1/s] requested
  double elapsed = 0.0;  ///< [s] wall time of the loop
  bool paced = true;
  bool cancelled = false;  ///< ended by the progress callback, or stopped before its duration was over
  std::uint64_t ticks = 0;
  std::uint64_t missed_deadlines = 0;  ///< periods without a tick: the tick before woke or ended too late
  DurationHistogram compute;           ///< servo.tick: processor time of the thread on Linux, wall time elsewhere
  DurationHistogram lateness;          ///< from deadline to wake-up, wall time; empty unless paced
  double clock_cost = 0.0;             ///< [s] median of two consecutive clock readings: included in every compute time
  double peak_force = 0.0;             ///< [N] longest force returned by the servo
  StatusCounters status;               ///< of servo and devices, one count per flag and tick
  std::vector<DeviceReport> devices;   ///< the same, one per device
  RealtimeGrant real_time;
};

/// A compact table: run parameters, percentiles, peak force, status counts, granted real-time privileges.
std::ostream& operator<<(std::ostream& out, const LoopReport& r);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/loop_report.ipp>
#endif
