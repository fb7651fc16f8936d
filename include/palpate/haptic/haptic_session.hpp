// Devices, tools and a tissue: everything between a hand and a model in one object.
#pragma once

#include <palpate/haptic/detail/loop_device.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/loop_options.hpp>
#include <palpate/haptic/loop_report.hpp>
#include <palpate/haptic/session_options.hpp>

#include <memory>
#include <tuple>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {
class HapticLoop;
}

/// One or more devices with a tool each, one tissue, one servo and one loop. Force limits, coupling stiffness and rate
/// are what each device's limits() say; the loop and the servo have one rate. State number i, read from device i, moves
/// tool i, and force number i is written to it; a status is noted (note(Status), where a device has it) by the device
/// of its tool. Every start begins as a new session does; the heat of motors alone is remembered.
///
/// Refers to devices and tissue, which must outlive it; neither copied nor moved. Threads: start, run, stop and the
/// destructor belong to one thread; running and progress to any; snapshot to one reader. For an SDK that owns the
/// servo's thread, HapticServo::tick in its callback.
class HapticSession {
 public:
  /// Throws bad_argument for what HapticServo refuses, for options beyond what a device says (SessionOptions), when
  /// there is not one tool per device, and for a device given twice. Allocates all a tick needs.
  template <HapticDevice D, class T>
  HapticSession(D& device, T& tissue, const ToolList& tool, const SessionOptions& options = {})
      : HapticSession(std::vector<detail::LoopDevice>{detail::loop_device(device)}, TissueView(tissue), tool, options) {
  }
  /// Several devices of any types: std::tie(left, right).
  template <HapticDevice... D, class T>
  HapticSession(const std::tuple<D&...>& devices, T& tissue, const ToolList& tools, const SessionOptions& options = {})
      : HapticSession(detail::loop_devices(devices), TissueView(tissue), tools, options) {}
  /// A temporary device or tissue.
  template <class D, class T>
  requires((!std::is_lvalue_reference_v<D> && HapticDevice<D>) ||
           (!std::is_lvalue_reference_v<T> && !std::same_as<std::remove_cv_t<T>, TissueView>))
      HapticSession(D&&, T&&, const ToolList&, const SessionOptions& = {})
  = delete;
  HapticSession(const HapticSession&) = delete;
  HapticSession& operator=(const HapticSession&) = delete;
  /// Stops.
  ~HapticSession();

  /// Starts, calls the progress callback from this thread, stops, and reports. Throws bad_argument when nothing would
  /// end it, neither `duration` nor `progress`, and else as start does; what the callback throws comes through,
  /// stopped.
  LoopReport run(const LoopOptions& options);

  /// Starts the devices in order, then the haptic thread, and returns; ticks until stop(), or for `duration`. Throws
  /// bad_argument when it was started and not stopped, for a senseless duration, and for a progress callback, which no
  /// thread would call: ask progress(). What a device throws that cannot start comes through: that device and those
  /// before it are stopped, and nothing runs.
  void start(const LoopOptions& options = {});
  /// Ends the haptic thread after its tick, stops the devices, tells the tissue that nothing presses, and reports. The
  /// snapshot stays that of the last tick. An empty report when nothing was started.
  LoopReport stop();

  /// Whether the haptic thread ticks: false again once its duration is over, though devices are stopped by stop() only.
  bool running() const noexcept;
  LoopProgress progress() const noexcept;
  /// Newest snapshot; never waits. Valid until the next call.
  const ServoSnapshot& snapshot() noexcept { return servo_.read_snapshot(); }

  double rate() const noexcept { return rate_; }  ///< [1/s] of loop and servo
  /// Contacts, forces and gates of the last tick; not while running.
  const HapticServo& servo() const noexcept { return servo_; }

 private:
  HapticSession(const std::vector<detail::LoopDevice>& devices, const TissueView& tissue, const ToolList& tools,
                const SessionOptions& options);
  HapticSession(const std::vector<detail::LoopDevice>& devices, const TissueView& tissue, const ToolList& tools,
                const ServoOptions& options, bool limit_energy);

  HapticServo servo_;
  double rate_;
  std::unique_ptr<detail::HapticLoop> loop_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/haptic_session.ipp>
#endif
