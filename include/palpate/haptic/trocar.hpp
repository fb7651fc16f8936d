// A port in the body wall: a tool that passes through a trocar moves about it.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <limits>
#include <optional>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// A port, and the shaft of the tool that passes through it. The handle is outside, the tip inside the body.
struct TrocarPort {
  Vector3 position = Vector3::Zero();  ///< of the port, scene [m]
  Vector3 shaft{0.0, 0.0, -1.0};       ///< from the handle to the tip, in the handle's frame; of any length but zero
  double length = 0.3;                 ///< [m] from the handle to the tip
  double longest_lever = 3.0;          ///< FulcrumDevice: most of the length inside, relative to that outside
  double stiffness = 500.0;            ///< [N/m] PortedDevice: across the shaft, at the port

  /// Throws bad_argument unless position and shaft are finite, the shaft is not zero, and the other values are positive
  /// and finite.
  void require_valid() const;
};

namespace detail {

/// Throws bad_argument for a port that is stiffer than the device renders stably.
void require_stable_port(const TrocarPort& port, const DeviceLimits& device);

/// What FulcrumDevice and PortedDevice do, for devices of any type.
class PortedShaft {
 public:
  /// Throws as the devices.
  PortedShaft(const TrocarPort& port, const DeviceLimits& device, double rate);

  // FulcrumDevice
  ToolState at_tip(const ToolState& handle) noexcept;
  GatedForce to_handle(const GatedForce& at_tip) noexcept;
  DeviceLimits limits_at_tip() const noexcept;

  // PortedDevice
  void take(const ToolState& handle) noexcept { state_ = handle; }
  GatedForce with_port(const GatedForce& at_handle) noexcept;

  void reset() noexcept;
  /// Of the last tick [m], and of the part inside relative to that outside.
  double deviation() const noexcept { return deviation_; }
  double lever() const noexcept { return inside_ / outside_; }

 private:
  GatedForce pass(const Vector3& force, const Vector3& torque, const GatedForce& given) noexcept;
  double least_outside() const noexcept { return port_.length / (1.0 + port_.longest_lever); }

  TrocarPort port_;
  DeviceLimits device_;
  ForceGate gate_;
  ToolState state_;    // of the handle
  Vector3 direction_;  // of the shaft, scene
  double outside_, inside_, deviation_ = 0.0;
};

}  // namespace detail

/// A device without orientation, as a tool that passes through a port: the handle is where the device is, the shaft
/// points from there through the port, and the tool's position is the tip. Force and torque at the tip become the force
/// at the handle that does the same work, within the device's limits by a gate of its own:
/// F = (u u^T - s/r (1 - u u^T)) f - (t x u) / r, with the shaft's direction u and its lengths r outside and s inside.
/// The session's stiffness and force are reduced by the longest lever, so that the device renders no more than it can.
/// Where the handle would come closer, the tip stays. A HapticDevice, in place of the other. Refers to the device;
/// neither copied nor moved. Orientation: `shaft` of the tool's frame is along u, without roll.
template <HapticDevice Device>
class FulcrumDevice {
 public:
  /// `rate` [1/s]: that of the session, where it is not the device's. Throws bad_argument for an invalid port or rate.
  FulcrumDevice(Device& device, const TrocarPort& port, std::optional<double> rate = {})
      : device_(&device), shaft_(port, limits_of(device), rate.value_or(limits_of(device).rate)) {}
  FulcrumDevice(const FulcrumDevice&) = delete;
  FulcrumDevice& operator=(const FulcrumDevice&) = delete;

  ToolState read() noexcept { return shaft_.at_tip(device_->read()); }
  Status write(const GatedForce& force) noexcept { return device_->write(shaft_.to_handle(force)); }
  DeviceLimits limits() const noexcept { return shaft_.limits_at_tip(); }
  void start() {
    shaft_.reset();
    device_->start();
  }
  void stop() noexcept { device_->stop(); }
  /// Length of the shaft inside relative to that outside, in the last tick.
  double lever() const noexcept { return shaft_.lever(); }

 private:
  static DeviceLimits limits_of(const Device& device) noexcept { return device.limits(); }

  Device* device_;
  detail::PortedShaft shaft_;
};

/// A device of six degrees of freedom, as a tool that passes through a port: where the shaft leaves the port, a spring
/// across the shaft draws it back: two bilateral rows, which act at the handle as a force and a torque, and are added
/// to those of the session before a gate of its own. Where the shaft is not at the port, nothing draws it. The tool's
/// position is the device's, that of the handle; give the tool the shape of tip and shaft in that frame. A
/// HapticDevice, in place of the other. Refers to the device; neither copied nor moved.
template <HapticDevice Device>
class PortedDevice {
 public:
  /// `rate` [1/s]: that of the session, where it is not the device's. Throws bad_argument for an invalid port or rate,
  /// and a port that is stiffer than the device renders stably.
  PortedDevice(Device& device, const TrocarPort& port, std::optional<double> rate = {})
      : device_(&device), shaft_(port, limits(), rate.value_or(limits().rate)) {
    detail::require_stable_port(port, limits());
  }
  PortedDevice(const PortedDevice&) = delete;
  PortedDevice& operator=(const PortedDevice&) = delete;

  ToolState read() noexcept {
    const ToolState state = device_->read();
    shaft_.take(state);
    return state;
  }
  Status write(const GatedForce& force) noexcept { return device_->write(shaft_.with_port(force)); }
  DeviceLimits limits() const noexcept { return std::as_const(*device_).limits(); }
  void start() {
    shaft_.reset();
    device_->start();
  }
  void stop() noexcept { device_->stop(); }
  /// Distance of the shaft from the port in the last tick [m].
  double deviation() const noexcept { return shaft_.deviation(); }

 private:
  Device* device_;
  detail::PortedShaft shaft_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/trocar.ipp>
#endif
