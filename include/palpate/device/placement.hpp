// Where a device works in a scene, and how motion and force are scaled between the two.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/setup_error.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <optional>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Scene position = scene_origin + scale rotation (device position - device_origin). A force of the scene reaches the
/// hand as force_scale rotation^T force. With scale s and force scale f a hand feels a stiffness s f times that of the
/// tissue, and does f / s times the work it would do there.
struct Placement {
  Vector3 device_origin = Vector3::Zero();  ///< [m] this point of the device's space ...
  Vector3 scene_origin = Vector3::Zero();   ///< [m] ... lies here in the scene
  Matrix3 rotation = Matrix3::Identity();   ///< turns device axes into scene axes
  double scale = 1.0;                       ///< scene metres per device metre; below 1 for small organs
  double force_scale = 1.0;                 ///< device newtons per scene newton

  /// Throws bad_argument unless origins are finite, both scales positive and `rotation` is one.
  void require_valid() const {
    const auto positive = [](double s) { return std::isfinite(s) && s > 0.0; };
    if (!device_origin.allFinite() || !scene_origin.allFinite())
      raise(SetupErrorKind::bad_argument, "an origin of the placement is not finite");
    if (!positive(scale) || !positive(force_scale))
      raise(SetupErrorKind::bad_argument,
            "the placement scales motion by " + number(scale) + " and force by " + number(force_scale),
            "Both must be finite and positive");
    if (!((rotation.transpose() * rotation - Matrix3::Identity()).norm() < 1e-9) || !(rotation.determinant() > 0.0))
      raise(SetupErrorKind::bad_argument, "the rotation of the placement is none",
            "Give three orthogonal unit columns, right-handed");
  }

  Vector3 to_scene(const Vector3& device) const noexcept {
    return scene_origin + scale * (rotation * (device - device_origin));
  }
  Vector3 to_device(const Vector3& scene) const noexcept {
    return device_origin + rotation.transpose() * (scene - scene_origin) / scale;
  }
  /// What the hand feels of a stiffness in the scene [N/m].
  double felt_stiffness(double scene_stiffness) const noexcept { return scale * force_scale * scene_stiffness; }

  /// The state of a tool in the scene: position, velocity and orientation.
  ToolState to_scene(ToolState state) const noexcept {
    state.position = to_scene(state.position);
    state.velocity = scale * (rotation * state.velocity);
    const auto& q = state.orientation;
    const Eigen::Quaterniond turned = Eigen::Quaterniond(rotation) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    state.orientation = {turned.w(), turned.x(), turned.y(), turned.z()};
    return state;
  }
  Vector3 force_to_device(const Vector3& force) const noexcept { return force_scale * (rotation.transpose() * force); }
  /// The work of a torque is scaled as that of a force; angles are not scaled.
  Vector3 torque_to_device(const Vector3& torque) const noexcept {
    return (force_scale / scale) * (rotation.transpose() * torque);
  }

  /// A device's limits as the scene sees them: a servo that keeps within these keeps within the device's.
  DeviceLimits limits_in_scene(const DeviceLimits& device) const noexcept {
    DeviceLimits scene = device;
    scene.peak_force = device.peak_force / force_scale;
    scene.continuous_force = device.continuous_force / force_scale;
    scene.peak_torque = device.peak_torque * scale / force_scale;
    scene.turning_stiffness = device.turning_stiffness * scale / force_scale;
    scene.stiffness = device.stiffness / (scale * force_scale);
    const Vector3 middle = 0.5 * (device.workspace_low + device.workspace_high);
    const Vector3 half = scale * (rotation.cwiseAbs() * (0.5 * (device.workspace_high - device.workspace_low)));
    scene.workspace_low = to_scene(middle) - half;
    scene.workspace_high = to_scene(middle) + half;
    return scene;
  }

  /// A sentence for the user when a stiffness of the scene [N/m], such as the servo's coupling, is more than the device
  /// renders stably; nothing when it is not. NaN counts as too much.
  std::optional<std::string> warning(const DeviceLimits& device, double scene_stiffness) const {
    const double felt = felt_stiffness(scene_stiffness);
    if (felt <= device.stiffness) return std::nullopt;
    return "the hand would feel " + number(felt) + " N/m (" + number(scene_stiffness) + " N/m times scale " +
           number(scale) + " times force_scale " + number(force_scale) + "), the device renders " +
           number(device.stiffness) + " N/m stably: make scale or force_scale " + number(device.stiffness / felt) +
           " times as large, or set coupling_stiffness to " + number(device.stiffness / (scale * force_scale)) + " N/m";
  }
};

/// A device placed in a scene; a HapticDevice that speaks the scene's coordinates. Its limits are those of the scene
/// side, so that `ServoOptions{.device = placed.limits()}` bounds what the hand feels. Refers to the device.
template <HapticDevice Device>
class PlacedDevice {
 public:
  /// Throws bad_argument for an invalid placement.
  PlacedDevice(Device& device, const Placement& placement) : device_(&device), placement_(placement) {
    placement_.require_valid();
  }

  ToolState read() noexcept { return placement_.to_scene(device_->read()); }
  Status write(const Vector3& force, const Vector3& torque) noexcept {
    return device_->write(placement_.force_to_device(force), placement_.torque_to_device(torque));
  }
  DeviceLimits limits() const noexcept { return placement_.limits_in_scene(std::as_const(*device_).limits()); }
  void start() { device_->start(); }
  void stop() noexcept { device_->stop(); }
  /// Passed on to devices that keep a log (Recorder).
  void note(Status status) noexcept requires requires(Device& d) { d.note(status); }
  { device_->note(status); }

  const Placement& placement() const noexcept { return placement_; }

 private:
  Device* device_;
  Placement placement_;
};

}}  // namespace palpate
