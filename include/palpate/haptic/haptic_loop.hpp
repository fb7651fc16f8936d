// The thread that serves devices at a constant rate.
#pragma once

#include <palpate/haptic/detail/loop_device.hpp>
#include <palpate/haptic/loop_options.hpp>
#include <palpate/haptic/loop_report.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Median difference of two consecutive clock readings [s].
double measured_clock_cost() noexcept;

/// The rate of a loop over devices [1/s]: that of the slowest device.
double rate_of(const std::vector<LoopDevice>& devices) noexcept;

/// Starts devices and, in its own thread, in each period reads all, ticks the servo once and writes all. State and
/// force number i are those of device i. Refers to devices and servo.
class HapticLoop {
 public:
  /// Throws bad_argument without a device, for one given twice (ids: its numbers), for a rate outside 0.1 to 1e5, and
  /// for one so low that the servo's gate would take every tick as missed (value and threshold: rates).
  HapticLoop(std::vector<LoopDevice> devices, const LoopServo& servo, double rate);
  /// Stops as `stop` does.
  ~HapticLoop();

  /// Throws bad_argument for an invalid duration, or when it was started and not stopped.
  void require_startable(const LoopOptions& options) const;
  /// Throws as require_startable, and what a device throws that cannot start; then that device and all before it are
  /// stopped, and no thread runs.
  void start(const LoopOptions& options);
  /// Ends and joins the thread, stops all devices, last one first. The report is empty when nothing was started.
  LoopReport stop();
  /// Starts, calls the progress callback until the loop ends, stops; also stops when the callback throws. Throws as
  /// start, and bad_argument for a loop that would never end: neither a duration nor a progress callback.
  LoopReport run(const LoopOptions& options);

  // Any thread
  bool is_running() const noexcept;
  LoopProgress progress() const noexcept;

  // The thread that starts and stops
  bool is_started() const noexcept;
  double rate() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/haptic_loop.ipp>
#endif
