// Report of a haptic loop.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/haptic/detail/realtime_thread.hpp>
#include <palpate/haptic/duration_histogram.hpp>

#include <iosfwd>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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
