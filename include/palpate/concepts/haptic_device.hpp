// What a haptic device is, and what passes between it and the tick. Plain numbers only: these types cross library
// borders.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// What a device says about its tool. SI units, the device's own frame.
struct ToolState {
  Vector3 position = Vector3::Zero();                                              ///< [m]
  Vector3 velocity = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());  ///< [m/s]; NaN: not given
  std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};                           ///< unit quaternion w x y z
  double time = 0.0;  ///< [s] when the state was read, monotonic
  std::uint32_t buttons = 0;
  bool valid = true;  ///< false: the device could not be read
};

class ForceGate;
struct Placement;

/// What a device is told to render: a force that has passed a force gate. Finite, within the gate's limits and without
/// jumps, because only ForceGate makes one that is not zero. Others can read and pass it on, but not change force or
/// torque.
class GatedForce {
 public:
  /// Zero.
  GatedForce() = default;

  const Vector3& force() const noexcept { return force_; }    ///< [N]
  const Vector3& torque() const noexcept { return torque_; }  ///< [N m]
  Status status;

 private:
  friend class ForceGate;
  friend struct Placement;  // expresses the force in the device's axes and scale
  GatedForce(const Vector3& force, const Vector3& torque, Status s) noexcept
      : status(s), force_(force), torque_(torque) {}

  Vector3 force_ = Vector3::Zero(), torque_ = Vector3::Zero();
};

/// What a device can take.
struct DeviceLimits {
  double peak_force = 3.3;                          ///< [N]
  double continuous_force = 0.88;                   ///< [N]
  double stiffness = 500.0;                         ///< [N/m] the most it renders stably at `rate`
  Vector3 workspace_low = Vector3::Constant(-0.1);  ///< [m]
  Vector3 workspace_high = Vector3::Constant(0.1);  ///< [m]
  double peak_torque = 0.0;                         ///< [N m]; 0: three actuated degrees of freedom, no torque
  double rotational_stiffness = 0.0;                   ///< [N m/rad] the most it renders stably; 0 without torque
  double rate = 1000.0;                             ///< [1/s] what it is meant to be served at, at most
};

/// A device that can be read and written from the haptic thread. `read` and `write` never throw, block, allocate or
/// lock; `write` takes nothing but a GatedForce, limits it to `limits()` and renders zero after `stop()` or an invalid
/// read. Laws: testing/device_laws.hpp.
template <class D>
concept HapticDevice = requires(D& device, const D& constant, const GatedForce& force) {
  { device.read() } noexcept -> std::same_as<ToolState>;
  { device.write(force) } noexcept -> std::same_as<Status>;
  { constant.limits() } noexcept -> std::same_as<DeviceLimits>;
  {device.start()};
  { device.stop() } noexcept;
};

}}  // namespace palpate
