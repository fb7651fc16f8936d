// Devices, tools and a tissue in one object, with its options: everything between a hand and a model.
#pragma once

#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/loop_report.hpp>
#include <palpate/haptic/servo_options.hpp>

#include <memory>
#include <tuple>

namespace palpate { inline namespace PALPATE_ABI {

/// Everything is optional: defaults of force limits, stiffness and rate are each device's limits(). A given value is
/// valid for all tools and may be lower than the devices allow, not higher.
struct SessionOptions {
  std::optional<double> rate{};                  ///< [1/s] default: that of the slowest device
  std::optional<double> coupling_stiffness{};    ///< [N/m] between proxy and device; default: that of each device,
                                                 ///< reduced in proportion at a lower rate
  std::optional<double> rotational_stiffness{};  ///< [N m/rad] the same for rotations
  std::optional<ForceLimits> force_limits{};     ///< default ForceLimits::from(each device, rate)
  ContactParameters contact{};                   ///< includes friction
  double stale_tissue_after = 0.5;  ///< [s] without update of a tissue that moves by itself until forces fade
  bool corrected_force = false;     ///< whether ForceError::expected is subtracted from the force, where its
                                    ///< bound is at most a fifth of the force, in part up to two fifths
  std::uint32_t grasp_buttons = 0;  ///< while one of these is pressed, the tool grasps the point it touched
  bool limit_energy = false;        ///< an EnergyTank per tool, EnergyLimits::from its device
};

/// The options of a servo for tools on these devices, one each. Throws bad_argument (ids: the device; value and
/// threshold) when there is not one device per tool, for a rate above a device's, and for a coupling or rotational
/// stiffness, force, torque or continuous force above that of a device, or force limits for another rate.
ServoOptions servo_options(const std::vector<DeviceLimits>& devices, std::size_t tools, const SessionOptions& options);

/// One or more devices with a tool each, one tissue, one servo and one loop. Force limits, coupling stiffness and rate
/// are those of each device's limits(); the loop and the servo have one rate. State number i, read from device i, moves
/// tool i, and force number i is written to device i; devices with a function note(Status), or note(Status, now),
/// receive the status of their tool and the present time that it was given. Every start begins as a new session does,
/// except that the heat of the motors is kept; so does a start that a ReplayDevice repeats.
///
/// Refers to devices and tissue, which must outlive it; neither copied nor moved. Threads: start, run, stop and the
/// destructor belong to one thread; running and progress to any; snapshot to one reader. For an SDK that owns the
/// servo thread, call HapticServo::tick in its callback.
class HapticSession {
 public:
  /// Throws bad_argument for what HapticServo refuses, for options beyond a device's limits (SessionOptions), when
  /// there is not one tool per device, and for a device given twice. Allocates everything that a tick needs.
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
