// A port in the body wall: a tool that passes through a trocar moves about it.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/detail/device_gate.hpp>

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
  double stiffness = 200.0;            ///< [N/m] PortedDevice: across the shaft, at the port
  double radius = 0.01;                ///< [m] PortedDevice: the shaft enters the port within it

  /// Throws bad_argument unless position and shaft are finite, the shaft is not zero, and the other values are positive
  /// and finite.
  void require_valid() const;
};

namespace detail {

/// What FulcrumDevice and PortedDevice do, for devices of any type.
class PortedShaft {
 public:
  /// Throws as the devices.
  PortedShaft(const TrocarPort& port, const DeviceLimits& device, double rate);
  /// Throws bad_argument for a port that is stiffer than the device renders stably.
  void require_stable(double rate) const;

  void take(const ToolState& handle) noexcept;
  void set_now(double now) noexcept { gate_.set_now(now); }
  void reset() noexcept;

  // FulcrumDevice
  ToolState at_tip(const ToolState& handle) noexcept;
  GatedForce to_handle(const GatedForce& at_tip) noexcept;
  DeviceLimits limits_at_tip() const noexcept;

  // PortedDevice
  GatedForce with_port(const GatedForce& at_handle) noexcept;
  DeviceLimits limits_beside_port() const noexcept;

  /// Of the last tick [m], and of the part inside relative to that outside.
  double deviation() const noexcept { return deviation_; }
  double lever() const noexcept { return inside_ / outside_; }
  bool is_in_port() const noexcept { return in_port_; }

 private:
  bool lacks_state() noexcept;
  double least_outside() const noexcept { return port_.length / (1.0 + port_.longest_lever); }
  /// Stiffness of the port about the handle [N m/rad].
  double about_handle() const noexcept { return port_.stiffness * port_.length * port_.length; }

  TrocarPort port_;
  DeviceLimits device_;
  DeviceGate gate_;    // with the state of the handle
  Vector3 direction_;  // of the shaft, scene
  double outside_, inside_, deviation_ = 0.0;
  double nearness_ = 1.0;  // of the handle: its distance from the port, relative to the least outside, at most 1
  bool has_direction_ = false, in_port_ = false;
};

/// A device around another one, with a port.
template <HapticDevice Device>
class DeviceAtPort {
 public:
  DeviceAtPort(const DeviceAtPort&) = delete;
  DeviceAtPort& operator=(const DeviceAtPort&) = delete;

  void start() {
    shaft_.reset();
    device_->start();
  }
  void stop() noexcept { device_->stop(); }
  /// For the gate, and for a device that keeps a log.
  void note(Status status, double now = std::numeric_limits<double>::quiet_NaN()) noexcept {
    shaft_.set_now(now);
    forward_note(*device_, status, now);
  }
  /// Forwards that of a replay.
  bool restarts() const noexcept requires requires(const Device& d) { d.restarts(); }
  { return std::as_const(*device_).restarts(); }

 protected:
  DeviceAtPort(Device& device, const TrocarPort& port, std::optional<double> rate)
      : device_(&device), shaft_(port, device_limits(), rate.value_or(device_limits().rate)) {}

  DeviceLimits device_limits() const noexcept { return std::as_const(*device_).limits(); }
  ToolState read_handle() noexcept {
    const ToolState state = device_->read();
    if (has_restarted(*device_)) shaft_.reset();
    shaft_.take(state);
    return state;
  }
  /// With the status of the gate, which the session does not know.
  Status write_handle(const GatedForce& force) noexcept { return force.status | device_->write(force); }

  Device* device_;
  PortedShaft shaft_;
};

}  // namespace detail

/// A device without orientation, as a tool that passes through a port: the handle is where the device is, the shaft
/// points from there through the port, and the tool's position is the tip. Force and torque at the tip become the force
/// at the handle that does the same work, within the device's limits by a gate of its own, whose ramp comes after that
/// of the session: F = (u u^T - s/r (1 - u u^T)) f - (t x u) / r, with the shaft's direction u and its lengths r
/// outside and s inside. The session's stiffness is reduced by the longest lever, so that the device renders no more
/// than it can. Where the handle comes closer to the port than that lever allows, the tip goes no farther in, and the
/// force fades with the distance from the port (degraded_model). A HapticDevice, in place of the other. Refers to the
/// device; neither copied nor moved. Orientation: `shaft` of the tool's frame is along u, without roll.
template <HapticDevice Device>
class FulcrumDevice : public detail::DeviceAtPort<Device> {
 public:
  /// `rate` [1/s]: that of the session, where it is not the device's. Throws bad_argument for an invalid port or rate.
  FulcrumDevice(Device& device, const TrocarPort& port, std::optional<double> rate = {})
      : detail::DeviceAtPort<Device>(device, port, rate) {}

  ToolState read() noexcept { return this->shaft_.at_tip(this->read_handle()); }
  Status write(const GatedForce& force) noexcept { return this->write_handle(this->shaft_.to_handle(force)); }
  DeviceLimits limits() const noexcept { return this->shaft_.limits_at_tip(); }
  /// Length of the shaft inside relative to that outside, in the last tick.
  double lever() const noexcept { return this->shaft_.lever(); }
};

/// A device of six degrees of freedom, as a tool that passes through a port: a spring across the shaft draws it to the
/// port, from when it enters within the radius of the port until it leaves: two bilateral rows, which act at the handle
/// as a force and a torque, and are added to those of the session before a gate of its own. The tool's position is the
/// device's, that of the handle; give the tool the shape of tip and shaft in that frame. Stiffness of the port is taken
/// from what the session may render. A HapticDevice, in place of the other. Refers to the device; neither copied nor
/// moved.
template <HapticDevice Device>
class PortedDevice : public detail::DeviceAtPort<Device> {
 public:
  /// `rate` [1/s]: that of the session, where it is not the device's. Throws bad_argument for an invalid port or rate,
  /// and for a port that is stiffer than the device renders stably: at the port, or, where it renders torque, about the
  /// handle (stiffness times length squared).
  PortedDevice(Device& device, const TrocarPort& port, std::optional<double> rate = {})
      : detail::DeviceAtPort<Device>(device, port, rate) {
    this->shaft_.require_stable(rate.value_or(this->device_limits().rate));
  }

  ToolState read() noexcept { return this->read_handle(); }
  Status write(const GatedForce& force) noexcept { return this->write_handle(this->shaft_.with_port(force)); }
  DeviceLimits limits() const noexcept { return this->shaft_.limits_beside_port(); }
  /// Distance of the shaft from the port in the last tick, while it is in it [m].
  double deviation() const noexcept { return this->shaft_.deviation(); }
  bool is_in_port() const noexcept { return this->shaft_.is_in_port(); }
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/trocar.ipp>
#endif
