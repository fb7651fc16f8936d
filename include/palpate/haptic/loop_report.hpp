// What goes into a haptic loop and what comes out: options, progress, real-time privileges, report.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/haptic/duration_histogram.hpp>

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Progress of a loop.
struct LoopProgress {
  double elapsed = 0.0;   ///< [s] since the start
  double fraction = 0.0;  ///< of its duration, 0 ... 1; 0 without one
  std::uint64_t ticks = 0;
  double force = 0.0;  ///< [N] of the last tick, the longest of all devices
};

/// The rate is not an option: a loop runs at the rate of its devices, or of the session that it belongs to.
struct LoopOptions {
  double duration = infinity;  ///< [s]; without one a loop runs until it is stopped or `progress` ends it
  bool paced = true;           ///< false: rate * duration ticks as fast as they go, for devices in simulated time
  bool real_time = false;      ///< request SCHED_FIFO and locked memory; not if unpaced: it would starve other threads
  double force_error = 0.1;    ///< largest bound of ForceError, relative to the force, that the report accepts
  int cpu = -1;                ///< pin the thread to this processor
  /// Called at most 10 times per second, in the caller's thread; false ends the loop.
  std::function<bool(const LoopProgress&)> progress{};
};

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

/// The errors of the contact forces of a loop, as GatedForce::error has them. A tick is in contact with a tool if its
/// contact force is not zero.
struct ForceErrorReport {
  double allowed = 0.1;                      ///< LoopOptions::force_error
  std::uint64_t contact = 0;                 ///< ticks in contact whose error is known
  std::uint64_t over = 0;                    ///< those of which the bound was above the allowed part of the force
  std::uint64_t unknown = 0;                 ///< ticks in contact without a measured error
  ForceError largest{0.0, 0.0, 0.0, {0.0}};  ///< that with the largest bound

  void count(const ForceError& error) noexcept;
  void count(const ForceErrorReport& other) noexcept;
  /// Of the ticks in contact whose error is known.
  double share_over() const noexcept {
    return contact > 0 ? static_cast<double>(over) / static_cast<double>(contact) : 0.0;
  }
};

/// One line: share of the ticks over the allowed error, the largest bound and its largest parts.
std::ostream& operator<<(std::ostream& out, const ForceErrorReport& r);

/// Report of one device of a loop.
struct DeviceReport {
  double peak_force = 0.0;  ///< [N] longest
  StatusCounters status;    ///< of its tool and of itself, one count per flag and tick
  ForceErrorReport errors;  ///< of its tool
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
  ForceErrorReport errors;             ///< of the contact forces, all tools together
  std::vector<DeviceReport> devices;   ///< the same, one per device
  RealtimeGrant real_time;
  std::vector<std::string> notes;  ///< of a session: HapticServo::notes
};

/// A compact table: run parameters, percentiles, peak force, errors of the forces, status counts, granted real-time
/// privileges, notes.
std::ostream& operator<<(std::ostream& out, const LoopReport& r);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/loop_report.ipp>
#endif
