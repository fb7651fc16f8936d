// Position of a device in a scene, and scaling of motion and force between the two.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Scene position = scene_origin + scale rotation (device position - device_origin). A force of the scene is rendered
/// as force_scale rotation^T force. With scale s and force scale f the rendered stiffness is s f times that of the
/// tissue, and the work of the hand is f / s times the work in the scene.
struct Placement {
  Vector3 device_origin = Vector3::Zero();  ///< [m] this point of the device's space
  Vector3 scene_origin = Vector3::Zero();   ///< [m] is at this point of the scene
  Matrix3 rotation = Matrix3::Identity();   ///< from device axes to scene axes
  double scale = 1.0;                       ///< scene metres per device metre; below 1 for small organs
  double force_scale = 1.0;                 ///< device newtons per scene newton

  /// Throws bad_argument unless origins are finite, both scales positive and `rotation` is a rotation matrix.
  void require_valid() const;

  Vector3 to_scene(const Vector3& device) const noexcept;
  Vector3 to_device(const Vector3& scene) const noexcept;
  /// Rendered stiffness for a stiffness in the scene [N/m].
  double handle_stiffness(double scene_stiffness) const noexcept { return scale * force_scale * scene_stiffness; }

  /// The state of a tool in the scene: position, velocity and orientation.
  ToolState to_scene(ToolState state) const noexcept;
  Vector3 force_to_device(const Vector3& force) const noexcept;
  /// The work of a torque is scaled as that of a force; angles are not scaled.
  Vector3 torque_to_device(const Vector3& torque) const noexcept;
  /// Force and torque of the scene in the device's axes and scale.
  GatedForce to_device(const GatedForce& scene) const noexcept;

  /// A device's limits in units of the scene: a servo within these limits is within the device's limits.
  DeviceLimits limits_in_scene(const DeviceLimits& device) const noexcept;

  /// A message for the user when a stiffness of the scene [N/m], such as the servo's coupling, is more than the device
  /// renders stably; otherwise nothing. NaN counts as too much.
  std::optional<std::string> warning(const DeviceLimits& device, double scene_stiffness) const;
};

/// A device placed in a scene: a HapticDevice in the scene's coordinates. Its limits are those of the scene side, so
/// that a HapticSession with it limits what the device renders. Refers to the device.
template <HapticDevice Device>
class PlacedDevice {
 public:
  /// Throws bad_argument for an invalid placement.
  PlacedDevice(Device& device, const Placement& placement) : device_(&device), placement_(placement) {
    placement_.require_valid();
  }

  ToolState read() noexcept { return placement_.to_scene(device_->read()); }
  Status write(const GatedForce& force) noexcept { return device_->write(placement_.to_device(force)); }
  DeviceLimits limits() const noexcept { return placement_.limits_in_scene(std::as_const(*device_).limits()); }
  void start() { device_->start(); }
  void stop() noexcept { device_->stop(); }
  /// Forwards status and present time to a device that keeps a log (Recorder).
  void note(Status status, double now = std::numeric_limits<double>::quiet_NaN()) noexcept requires
      requires(Device& d) {
    d.note(status);
  }
  {
    if constexpr (requires(Device & d) { d.note(status, now); })
      device_->note(status, now);
    else
      device_->note(status);
  }
  /// Forwards that of a replay.
  bool restarts() const noexcept requires requires(const Device& d) { d.restarts(); }
  { return std::as_const(*device_).restarts(); }

 private:
  Device* device_;
  Placement placement_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/placement.ipp>
#endif
