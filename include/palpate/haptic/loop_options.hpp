// What a haptic loop is asked for, and what it tells on its way.
#pragma once

#include <palpate/core/config.hpp>

#include <cstdint>
#include <functional>

namespace palpate { inline namespace PALPATE_ABI {

/// Where a loop stands.
struct LoopProgress {
  double elapsed = 0.0;   ///< [s] of its duration
  double fraction = 0.0;  ///< 0 ... 1
  std::uint64_t ticks = 0;
  double force = 0.0;  ///< [N] of the last tick
};

struct LoopOptions {
  double rate = 1000.0;    ///< [1/s]
  double duration = 10.0;  ///< [s]
  bool paced = true;       ///< false: rate * duration ticks as fast as they go, for devices in simulated time
  bool real_time = false;  ///< ask for SCHED_FIFO and locked memory; not if unpaced: it would starve other threads
  int cpu = -1;            ///< pin the thread to this processor
  /// Called at most 10 times per second, in the caller's thread; false ends the loop.
  std::function<bool(const LoopProgress&)> progress{};
};

}}  // namespace palpate
