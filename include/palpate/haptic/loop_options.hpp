// Options of a haptic loop, and its progress.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <cstdint>
#include <functional>

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

}}  // namespace palpate
