// Runs devices and a user-defined servo at a constant rate and reports measured times and missed deadlines.
#pragma once

#include <palpate/concepts/servo.hpp>
#include <palpate/haptic/detail/loop_device.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/loop_options.hpp>
#include <palpate/haptic/loop_report.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

LoopReport run_loop(std::vector<LoopDevice> devices, const LoopServo& servo, const LoopOptions& options);

}  // namespace detail

/// For a user-defined servo; HapticSession constructs one that fits the device. Starts the device and, in its own
/// thread with denormals flushed, in each period of the device's rate reads it, ticks the servo with that one state and
/// writes the force; then stops the device in all cases. Returns when `duration` has passed or the progress callback
/// returned false; one of the two must be given. A tick takes no lock and allocates nothing itself. In
/// a paced loop ToolState::now is set where the device does not give it. Forces are
/// written as the servo returns them: the force gate is the servo's last step. If the device has note(Status), or
/// note(Status, now) as a Recorder, it receives each tick's status, and the present time. Throws
/// SetupError(bad_argument) for invalid options, and what device.start() and the callback throw. If the servo has
/// limits() (HapticServo), a loop that is slower than its rate by a factor of ForceLimits::late_factor or more is
/// refused (bad_argument; value and threshold are rates): every tick would count as missed. A loop that is faster than
/// the servo's rate is accepted: the gate's limits are per second and its steps no longer than the time that passed,
/// and the coupling for a lower rate is the softer one.
template <HapticDevice Device, Servo S>
LoopReport run_haptic_loop(Device& device, S& servo, const LoopOptions& options) {
  return detail::run_loop({detail::loop_device(device)}, detail::loop_servo(servo), options);
}
/// The same for several devices, std::tie(left, right), at the rate of the slowest: each tick reads all, ticks the
/// servo once and writes all. State and force number i are those of device i. They start in order; when one throws, it
/// and those before it are stopped.
template <HapticDevice... Device, Servo S>
LoopReport run_haptic_loop(const std::tuple<Device&...>& devices, S& servo, const LoopOptions& options) {
  return detail::run_loop(detail::loop_devices(devices), detail::loop_servo(servo), options);
}

inline LoopReport detail::run_loop(std::vector<LoopDevice> devices, const LoopServo& servo,
                                   const LoopOptions& options) {
  const double rate = rate_of(devices);
  return HapticLoop(std::move(devices), servo, rate).run(options);
}

}}  // namespace palpate
