// Concepts of a haptic device and of the servo that computes its forces, and the types exchanged between them. Plain
// numbers only: these types cross library boundaries.
#pragma once

#include <palpate/concepts/force_error.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <concepts>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// State of the tool as the device reports it. SI units, in the device's own frame.
///
/// Poses older than ForceLimits::stale_after fade the force, so `time` must be the time at which the pose was measured,
/// also where it waited in a queue. The age is `now - time`. A device that sets `now` may stamp with any clock that does
/// not run backwards; in simulated time, `now` is the simulated time. Where it is NaN, a paced haptic loop sets it:
/// - Stamps of std::chrono::steady_clock, in seconds since its epoch, have exact ages. They are recognised by a first
///   stamp that is less than 1 s old.
/// - Stamps of another clock are compared with the youngest pose so far: a delay that grows beyond `stale_after` fades
///   the force, one that is the same from the start is not noticed. Such a clock may be slow by a thousandth.
/// Without a loop, or in an unpaced one, set it, or only stamps that do not change become stale.
struct ToolState {
  Vector3 position = Vector3::Zero();                                              ///< [m]
  Vector3 velocity = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< [m/s]; NaN: not given
  std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};                           ///< unit quaternion w x y z
  double time = 0.0;  ///< [s] monotonic time at which the pose was measured
  double now = std::numeric_limits<double>::quiet_NaN();  ///< [s] present time on the same clock; NaN: not given
  std::uint32_t buttons = 0;
  bool valid = true;  ///< false: the device could not be read
};

class ForceGate;
struct Placement;

/// The command to a device: a force that has passed a force gate. It is finite, within the gate's limits and without
/// jumps, because only ForceGate creates a nonzero one. Other code can read it and pass it on, but cannot change force
/// or torque.
class GatedForce {
 public:
  /// Zero.
  GatedForce() = default;

  const Vector3& force() const noexcept { return force_; }    ///< [N]
  const Vector3& torque() const noexcept { return torque_; }  ///< [N m]
  Status status;
  ForceError error;  ///< of the contact force from which it was made

 private:
  friend class ForceGate;
  friend struct Placement;  // expresses the force in the device's axes and scale
  GatedForce(const Vector3& force, const Vector3& torque, Status s) noexcept
      : status(s), force_(force), torque_(torque) {}

  Vector3 force_ = Vector3::Zero(), torque_ = Vector3::Zero();
};

/// Limits of a device.
struct DeviceLimits {
  double peak_force = 3.3;                          ///< [N]
  double continuous_force = 0.88;                   ///< [N]
  double stiffness = 500.0;                         ///< [N/m] largest that it renders stably at `rate`
  Vector3 workspace_low = Vector3::Constant(-0.1);  ///< [m]
  Vector3 workspace_high = Vector3::Constant(0.1);  ///< [m]
  double peak_torque = 0.0;                         ///< [N m]; 0: three actuated degrees of freedom, no torque
  double rotational_stiffness = 0.0;                ///< [N m/rad] largest that it renders stably; 0 without torque
  double length_scale = 1.0;                        ///< length in these limits per length at the handle (Placement)
  double rate = 1000.0;                             ///< [1/s] highest intended update rate
};

/// A device that can be read and written from the haptic thread. `read` and `write` never throw, block, allocate or
/// lock. `write` accepts only a GatedForce, limits it to `limits()` and renders zero after `stop()` or an invalid
/// read. Laws: testing/device_laws.hpp.
template <class D>
concept HapticDevice = requires(D& device, const D& constant, const GatedForce& force) {
  { device.read() } noexcept -> std::same_as<ToolState>;
  { device.write(force) } noexcept -> std::same_as<Status>;
  { constant.limits() } noexcept -> std::same_as<DeviceLimits>;
  {device.start()};
  { device.stop() } noexcept;
};

/// Computes the forces on all tools from the states of all tools, once per tick. `tick` receives one state per tool and
/// returns one force per tool in the same order; the span stays valid until the next tick. It never throws, blocks,
/// allocates or locks. The result is sent to the device, so the last step of `tick` is a force gate.
template <class S>
concept Servo = requires(S& servo, std::span<const ToolState> tools) {
  { servo.tick(tools) } noexcept -> std::same_as<std::span<const GatedForce>>;
};

}}  // namespace palpate
