// Definitions of placement.hpp.
#pragma once

#include <palpate/device/placement.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void Placement::require_valid() const {
  const auto positive = [](double s) { return std::isfinite(s) && s > 0.0; };
  if (!all_finite(device_origin) || !all_finite(scene_origin))
    raise(SetupErrorKind::bad_argument, "an origin of the placement is not finite");
  if (!positive(scale) || !positive(force_scale))
    raise(SetupErrorKind::bad_argument,
          "the placement scales motion by " + number(scale) + " and force by " + number(force_scale),
          "Both must be finite and positive");
  if (!is_rotation(rotation))
    raise(SetupErrorKind::bad_argument, "the rotation of the placement is not a rotation matrix",
          "Give three orthogonal unit columns, right-handed");
}

PALPATE_INLINE Vector3 Placement::to_scene(const Vector3& device) const noexcept {
  return scene_origin + scale * (rotation * (device - device_origin));
}

PALPATE_INLINE Vector3 Placement::to_device(const Vector3& scene) const noexcept {
  return device_origin + rotation.transpose() * (scene - scene_origin) / scale;
}

PALPATE_INLINE ToolState Placement::to_scene(ToolState state) const noexcept {
  state.position = to_scene(state.position);
  state.velocity = scale * (rotation * state.velocity);
  const auto& q = state.orientation;
  const Quaternion<double> rotated = quaternion_of(rotation) * Quaternion<double>{q[0], q[1], q[2], q[3]};
  state.orientation = {rotated.w, rotated.x, rotated.y, rotated.z};
  return state;
}

PALPATE_INLINE Vector3 Placement::force_to_device(const Vector3& force) const noexcept {
  return force_scale * (rotation.transpose() * force);
}

PALPATE_INLINE Vector3 Placement::torque_to_device(const Vector3& torque) const noexcept {
  return (force_scale / scale) * (rotation.transpose() * torque);
}

PALPATE_INLINE GatedForce Placement::to_device(const GatedForce& scene) const noexcept {
  GatedForce device(force_to_device(scene.force()), torque_to_device(scene.torque()), scene.status);
  device.error = scene.error * force_scale;
  return device;
}

PALPATE_INLINE DeviceLimits Placement::limits_in_scene(const DeviceLimits& device) const noexcept {
  DeviceLimits scene = device;
  scene.length_scale = scale * device.length_scale;
  scene.peak_force = device.peak_force / force_scale;
  scene.continuous_force = device.continuous_force / force_scale;
  scene.peak_torque = device.peak_torque * scale / force_scale;
  scene.rotational_stiffness = device.rotational_stiffness * scale / force_scale;
  scene.stiffness = device.stiffness / (scale * force_scale);
  const Vector3 middle = 0.5 * (device.workspace_low + device.workspace_high);
  const Vector3 reach = 0.5 * (device.workspace_high - device.workspace_low);
  Vector3 half;  // of the box around the rotated workspace
  for (int i = 0; i < 3; ++i)
    half[i] = scale * (std::abs(rotation(i, 0)) * reach[0] + std::abs(rotation(i, 1)) * reach[1] +
                       std::abs(rotation(i, 2)) * reach[2]);
  scene.workspace_low = to_scene(middle) - half;
  scene.workspace_high = to_scene(middle) + half;
  return scene;
}

PALPATE_INLINE std::optional<std::string> Placement::warning(const DeviceLimits& device, double scene_stiffness) const {
  const double rendered = handle_stiffness(scene_stiffness);
  if (rendered <= device.stiffness) return std::nullopt;
  return "the rendered stiffness would be " + number(rendered) + " N/m (" + number(scene_stiffness) +
         " N/m times scale " + number(scale) + " times force_scale " + number(force_scale) + "), the device renders " +
         number(device.stiffness) + " N/m stably: make scale or force_scale " + number(device.stiffness / rendered) +
         " times as large, or set coupling_stiffness to " + number(device.stiffness / (scale * force_scale)) + " N/m";
}

}}  // namespace palpate
