// What ticks: a session in real time, or a servo in virtual time.
#pragma once

#include <palpate/haptic/haptic_session.hpp>

#include "any_device.hpp"
#include "organ.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace live {

using Taps = std::vector<std::unique_ptr<Tap>>;

class Loop {
 public:
  virtual ~Loop() = default;
  virtual const ServoSnapshot& snapshot() = 0;
  /// In virtual time: ticks for so long [s], and calls `before_tick(time)` in this thread. In real time: calls it once.
  virtual void run(double seconds, const std::function<void(double time)>& before_tick) = 0;
  virtual double time() const = 0;  ///< [s] since the start
  /// Ends ticks and devices: nothing presses any more.
  virtual LoopReport stop() = 0;
  virtual WorkerReport work_report() const = 0;
};

/// A HapticSession: its own thread ticks a thousand times a second, a BackgroundWorker steps and cuts.
std::unique_ptr<Loop> start_real_time(Organ& organ, Taps& taps, const std::vector<Tool>& tools,
                                      const ServoOptions& options);
/// A HapticServo ticked by the caller, and background work at fixed times: the same in every run.
std::unique_ptr<Loop> start_virtual_time(Organ& organ, Taps& taps, const std::vector<Tool>& tools,
                                         const ServoOptions& options);

}  // namespace live
