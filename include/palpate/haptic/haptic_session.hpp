// Devices, tools and a tissue in one object: everything between a hand and a model.
#pragma once

#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/loop_report.hpp>
#include <palpate/haptic/servo_options.hpp>

#include <memory>
#include <tuple>

namespace palpate { inline namespace PALPATE_ABI {

/// The options with these devices, a tool on each. Throws bad_argument (ids: the device; value and threshold) when
/// there is not one device per tool or the options have devices already, for a rate above a device's, and for a
/// coupling or rotational stiffness, force, torque or continuous force above that of a device, or force limits for
/// another rate.
ServoOptions servo_options(const std::vector<DeviceLimits>& devices, std::size_t tools, const ServoOptions& options);

/// One or more devices with a tool each, one tissue or a TissueGroup, one servo and one loop. Force limits, coupling
/// stiffness and rate are those of each device's limits(); the loop and the servo have one rate. State number i, read
/// from device i, moves tool i, and force number i is written to device i; devices with a function note(Status), or
/// note(Status, now), receive the status of their tool and the present time that it was given. Every start begins as a
/// new session does, except that the heat of the motors is kept; so does a start that a ReplayDevice repeats.
///
/// Refers to devices and tissue, which must outlive it; neither copied nor moved. Threads: start, run, stop and the
/// destructor belong to one thread; running and progress to any; snapshot to one reader. For an SDK that owns the
/// servo thread, call HapticServo::tick in its callback.
class HapticSession {
 public:
  /// Throws bad_argument for what HapticServo refuses, for options beyond a device's limits or with devices,
  /// when there is not one tool per device, and for a device given twice. Allocates everything that a tick needs.
  template <HapticDevice D, class T>
  requires(!std::same_as<std::remove_cv_t<T>, TissueGroup>)
      HapticSession(D& device, T& tissue, const ToolList& tool, const ServoOptions& options = {})
      : HapticSession(std::vector<detail::LoopDevice>{detail::loop_device(device)}, TissueView(tissue), tool, options) {
  }
  template <HapticDevice D>
  HapticSession(D& device, const TissueGroup& tissues, const ToolList& tool, const ServoOptions& options = {})
      : HapticSession(std::vector<detail::LoopDevice>{detail::loop_device(device)}, tissues.members(), tool, options,
                      &detail::shared_tools()) {}
  /// Several devices of any types: std::tie(left, right).
  template <HapticDevice... D, class T>
  requires(!std::same_as<std::remove_cv_t<T>, TissueGroup>)
      HapticSession(const std::tuple<D&...>& devices, T& tissue, const ToolList& tools,
                    const ServoOptions& options = {})
      : HapticSession(detail::loop_devices(devices), TissueView(tissue), tools, options) {}
  template <HapticDevice... D>
  HapticSession(const std::tuple<D&...>& devices, const TissueGroup& tissues, const ToolList& tools,
                const ServoOptions& options = {})
      : HapticSession(detail::loop_devices(devices), tissues.members(), tools, options, &detail::shared_tools()) {}
  /// A temporary device or tissue.
  template <class D, class T>
  requires((!std::is_lvalue_reference_v<D> && HapticDevice<D>) || (!std::is_lvalue_reference_v<T> && TissueModel<T>))
      HapticSession(D&&, T&&, const ToolList&, const ServoOptions& = {})
  = delete;
  HapticSession(const HapticSession&) = delete;
  HapticSession& operator=(const HapticSession&) = delete;
  /// Stops.
  ~HapticSession();

  /// Starts, calls the progress callback from this thread, stops, and reports. Throws bad_argument when it would never
  /// end (neither `duration` nor `progress`), and otherwise as start does. Stops and rethrows when the callback throws.
  LoopReport run(const LoopOptions& options);

  /// Starts the devices in order, then the haptic thread, and returns; ticks until stop(), or for `duration`. Throws
  /// bad_argument when it was started and not stopped, for an invalid duration, and for a progress callback, which no
  /// thread would call: use progress(). When a device throws in start, that device and those before it are stopped, no
  /// thread runs, and the exception is passed on.
  void start(const LoopOptions& options = {});
  /// Ends the haptic thread after its tick, stops the devices, reports to the tissue that nothing presses, and returns
  /// the report. The snapshot stays that of the last tick. The report is empty when nothing was started.
  LoopReport stop();

  /// Whether the haptic thread ticks: false after its duration has ended, although only stop() stops the devices.
  bool running() const noexcept { return loop_->is_running(); }
  LoopProgress progress() const noexcept { return loop_->progress(); }
  /// Newest snapshot; never waits. Valid until the next call.
  const ServoSnapshot& snapshot() noexcept { return servo_.read_snapshot(); }

  double rate() const noexcept { return rate_; }  ///< [1/s] of loop and servo
  /// Contacts, forces and gates of the last tick; not while running.
  const HapticServo& servo() const noexcept { return servo_; }
  /// As those of HapticServo; for any thread, also while running. A coupling stiffer than the device renders stably is
  /// refused as bad_argument.
  void set_friction(double coefficient, std::size_t tissue = 0) { servo_.set_friction(coefficient, tissue); }
  void set_coupling_stiffness(double stiffness, std::size_t tool = 0);

 private:
  using Devices = std::vector<detail::LoopDevice>;
  HapticSession(const Devices& devices, const TissueView& tissue, const ToolList& tools, const ServoOptions& options)
      : HapticSession(devices, GroupMember{tissue}, tools, options) {}
  HapticSession(const Devices& devices, const GroupMember& member, const ToolList& tools, const ServoOptions& options)
      : HapticSession(devices, HapticServo::Members(&member, 1), tools, options, nullptr) {}
  HapticSession(const Devices& devices, HapticServo::Members members, const ToolList& tools,
                const ServoOptions& options, const detail::SharedTools* shared);

  HapticServo servo_;
  std::vector<DeviceLimits> limits_;  // of the devices
  double rate_;
  std::unique_ptr<detail::HapticLoop> loop_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/haptic_session.ipp>
#endif
