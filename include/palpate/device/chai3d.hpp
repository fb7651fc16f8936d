// Any device of CHAI3D 3. Needs no header of CHAI3D: its types are template arguments. Tested against a fake written
// for this project, never on hardware: run testing/device_laws.hpp on your device, with no hand on the handle.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/device/detail/sdk_state.hpp>
#include <palpate/device/render_limits.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

struct Chai3dOptions {
  std::optional<DeviceLimits> limits;  ///< instead of CHAI3D's table, which has only peak force, stiffness and radius
  bool torque = false;                 ///< the device has motors for torque, and `limits` has their limits
};

/// A cGenericHapticDevice as a HapticDevice, for loops of the application (HapticSession), in CHAI3D's frame: x to the
/// user, y to the right, z up. SI units. Refers to the device:
///   Chai3dDevice<chai3d::cGenericHapticDevice, chai3d::cVector3d, chai3d::cMatrix3d> stylus(*device_pointer);
/// The limits are those of CHAI3D's specification of the device, which CHAI3D itself does not enforce. Its header calls
/// the force continuous, but the numbers are the makers' peaks (3.3 N for an Omni); the continuous force is set to a
/// quarter of it.
template <class Device, class Vector, class Matrix>
class Chai3dDevice {
 public:
  /// Opens the device. Throws SetupError(unsupported) when that fails, (bad_argument) when its specification has no
  /// positive force, stiffness and workspace (the device without hardware) and no limits are given, or when torque is
  /// requested without limits for it.
  explicit Chai3dDevice(Device& device, const Chai3dOptions& options = {})
      : device_(&device),
        options_(options),
        rendered_(detail::with_torque(options.limits ? *options.limits : specified(device), options.torque)) {
    if (!device.open()) refuse("open the device");
  }
  ~Chai3dDevice() {
    stop();
    device_->close();
  }
  Chai3dDevice(const Chai3dDevice&) = delete;
  Chai3dDevice& operator=(const Chai3dDevice&) = delete;

  ToolState read() noexcept {
    ToolState state;
    Vector position, velocity;
    Matrix rotation;
    state.valid = device_->getPosition(position);
    state.time = clock_.now();
    const Vector3 p(position.x(), position.y(), position.z());
    if (!all_finite(p)) state.valid = false;
    if (state.valid) {
      state.position = p;
      if (device_->getLinearVelocity(velocity)) {
        const Vector3 v(velocity.x(), velocity.y(), velocity.z());
        if (all_finite(v)) state.velocity = v;
      }
      if (device_->getRotation(rotation)) orient(state, rotation);
      unsigned int buttons = 0;
      if (device_->getUserSwitches(buttons)) state.buttons = buttons;
    }
    rendered_.read_was(state.valid);
    return state;
  }

  Status write(const GatedForce& force) noexcept {
    Status status = rendered_.render(force);
    if (!send(rendered_.force(), rendered_.torque())) {
      status.set(StatusFlag::disconnected);
      rendered_.read_was(false);
    }
    return status;
  }

  DeviceLimits limits() const noexcept { return rendered_.limits(); }
  void start() noexcept {
    running_ = true;
    rendered_.start();
  }
  void stop() noexcept {
    rendered_.stop();
    if (running_) send(Vector3::Zero(), Vector3::Zero());
    running_ = false;
  }

  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] rendered last
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same

 private:
  [[noreturn]] static void refuse(const char* what) {
    raise(SetupErrorKind::unsupported, std::string("CHAI3D could not ") + what,
          "Is it plugged in, and its driver installed?");
  }
  static DeviceLimits specified(Device& device) {
    const auto info = device.getSpecifications();
    const double force = info.m_maxLinearForce, stiffness = info.m_maxLinearStiffness, radius = info.m_workspaceRadius;
    for (double value : {force, stiffness, radius})
      if (!(std::isfinite(value) && value > 0.0))
        raise(SetupErrorKind::bad_argument, "CHAI3D's specification of the device contains " + number(value),
              "Give Chai3dOptions::limits");
    return {.peak_force = force,
            .continuous_force = 0.25 * force,
            .stiffness = stiffness,
            .workspace_low = Vector3::Constant(-radius),
            .workspace_high = Vector3::Constant(radius),
            .peak_torque = info.m_maxAngularTorque,
            .rotational_stiffness = info.m_maxAngularStiffness};
  }
  static void orient(ToolState& state, const Matrix& m) noexcept {
    Matrix3 rotation;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) rotation(i, j) = m(static_cast<unsigned>(i), static_cast<unsigned>(j));
    detail::orient(state, rotation);
  }
  bool send(const Vector3& f, const Vector3& t) const noexcept {
    const Vector force(f[0], f[1], f[2]);
    if (!options_.torque) return device_->setForce(force);
    return device_->setForceAndTorque(force, Vector(t[0], t[1], t[2]));
  }

  Device* device_;
  Chai3dOptions options_;
  RenderLimits rendered_;
  detail::SteadyStamp clock_;
  bool running_ = false;
};

}}  // namespace palpate
