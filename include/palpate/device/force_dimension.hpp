// Force Dimension (DHD 3): omega, delta, sigma, lambda. Include <dhdc.h> before this header. Tested against a fake
// written for this project, never on hardware: run testing/device_laws.hpp on your device, with no hand on the handle.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/device/detail/sdk_state.hpp>
#include <palpate/device/render_limits.hpp>

namespace palpate { inline namespace PALPATE_ABI {

struct ForceDimensionOptions {
  /// The SDK does not provide them: take them from the data sheet. The default forces are a quarter of those of an
  /// omega.3 (12 N).
  DeviceLimits limits{.peak_force = 3.0,
                      .continuous_force = 3.0,
                      .stiffness = 1000.0,
                      .workspace_low = Vector3::Constant(-0.06),
                      .workspace_high = Vector3::Constant(0.06)};
  bool torque = false;  ///< the device has motors for torque, and `limits` has their limits
};

/// A device of DHD as a HapticDevice, for loops of the application (HapticSession), in the device's frame. DHD uses SI
/// units. Every write sends a force, also a zero: the SDK computes gravity compensation when it receives a force. The
/// SDK's own limit is set to the peak force as a second guard; its brakes and its time guard stay unchanged.
class ForceDimensionDevice {
 public:
  /// Opens the first device that is free. Throws SetupError(unsupported) with the SDK's message when no device is free,
  /// (bad_argument) for torque without limits for it.
  explicit ForceDimensionDevice(const ForceDimensionOptions& options = {})
      : options_(options), rendered_(detail::with_torque(options.limits, options.torque)) {
    const int id = dhdOpen();
    if (id < 0) refuse("open a device");
    id_ = static_cast<char>(id);
  }
  ~ForceDimensionDevice() {
    stop();
    dhdClose(id_);
  }
  ForceDimensionDevice(const ForceDimensionDevice&) = delete;
  ForceDimensionDevice& operator=(const ForceDimensionDevice&) = delete;

  ToolState read() noexcept {
    double x = 0.0, y = 0.0, z = 0.0, rotation[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    ToolState state;
    state.valid = dhdGetPositionAndOrientationFrame(&x, &y, &z, rotation, id_) >= 0;
    state.time = clock_.now();
    const Vector3 position(x, y, z);
    if (!all_finite(position)) state.valid = false;
    if (state.valid) {
      state.position = position;
      orient(state, rotation);
      Vector3 v;
      if (dhdGetLinearVelocity(&v[0], &v[1], &v[2], id_) >= 0 && all_finite(v)) state.velocity = v;
      state.buttons = dhdGetButtonMask(id_);
    }
    rendered_.read_was(state.valid);
    return state;
  }

  Status write(const GatedForce& force) noexcept {
    Status status = rendered_.render(force);
    const int answer = send(rendered_.force(), rendered_.torque());
    if (answer < 0) {
      status.set(StatusFlag::disconnected);
      rendered_.read_was(false);
    }
    if (answer == motor_saturated) status.set(StatusFlag::saturated);
    return status;
  }

  DeviceLimits limits() const noexcept { return rendered_.limits(); }
  /// Throws SetupError(unsupported) with the SDK's message when forces cannot be enabled.
  void start() {
    if (dhdSetMaxForce(rendered_.limits().peak_force, id_) < 0) refuse("set the largest force");
    if (dhdEnableForce(1, id_) < 0) refuse("enable forces");
    running_ = true;
    rendered_.start();
  }
  void stop() noexcept {
    rendered_.stop();
    if (!running_) return;
    running_ = false;
    send(Vector3::Zero(), Vector3::Zero());
    dhdEnableForce(0, id_);
  }

  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] rendered last
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same

 private:
  static constexpr int motor_saturated = 2;  ///< DHD_MOTOR_SATURATED

  [[noreturn]] static void refuse(const std::string& what) {
    raise(SetupErrorKind::unsupported, "DHD could not " + what + ": " + std::string(dhdErrorGetLastStr()),
          "Try the device with the vendor's own test program first");
  }
  int send(const Vector3& f, const Vector3& t) const noexcept {
    return options_.torque ? dhdSetForceAndTorque(f[0], f[1], f[2], t[0], t[1], t[2], id_)
                           : dhdSetForce(f[0], f[1], f[2], id_);
  }
  static void orient(ToolState& state, const double (&r)[3][3]) noexcept {
    Matrix3 rotation;
    rotation << r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2];
    detail::orient(state, rotation);
  }

  ForceDimensionOptions options_;
  RenderLimits rendered_;
  detail::SteadyStamp clock_;
  char id_ = -1;
  bool running_ = false;
};

static_assert(HapticDevice<ForceDimensionDevice>);

}}  // namespace palpate
