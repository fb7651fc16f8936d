// Definitions of trocar.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/trocar.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void TrocarPort::require_valid() const {
  const auto is_positive = [](double v) { return v > 0.0 && v < infinity; };
  if (!(all_finite(position) && all_finite(shaft) && shaft.norm() > 0.0))
    raise(SetupErrorKind::bad_argument, "a port has no finite position, or its shaft no direction",
          "Give TrocarPort::shaft a length above zero");
  if (!(is_positive(length) && is_positive(longest_lever) && is_positive(stiffness)))
    raise(SetupErrorKind::bad_argument, "length, lever and stiffness of a port must be positive and finite");
}

namespace detail {

inline TrocarPort checked(TrocarPort port) {
  port.require_valid();
  port.shaft /= port.shaft.norm();
  return port;
}

PALPATE_INLINE void require_stable_port(const TrocarPort& port, const DeviceLimits& device) {
  if (port.stiffness <= device.stiffness) return;
  SetupProblem problem;
  problem.what = "the stiffness of a port is " + number(port.stiffness) + " N/m, the device renders " +
                 number(device.stiffness) + " N/m stably";
  problem.hint = "Reduce TrocarPort::stiffness";
  problem.value = port.stiffness;
  problem.threshold = device.stiffness;
  raise(std::move(problem));
}

PALPATE_INLINE PortedShaft::PortedShaft(const TrocarPort& port, const DeviceLimits& device, double rate)
    : port_(checked(port)),
      device_(device),
      gate_(ForceLimits::from(device, rate)),
      direction_(port_.shaft),
      outside_(0.5 * port_.length),
      inside_(0.5 * port_.length) {}

/// The rotation by the smallest angle from `from` to `to`, unit vectors; by a half turn about any axis across where
/// they are opposite.
inline Quaternion<double> shortest_rotation(const Vector3& from, const Vector3& to) noexcept {
  const Vector3 axis = cross(from, to);
  const double w = 1.0 + from.dot(to);
  if (w > 1e-9) return normalized(Quaternion<double>{w, axis[0], axis[1], axis[2]});
  const Vector3 across =
      std::abs(from[0]) < 0.9 ? cross(from, Vector3(1.0, 0.0, 0.0)) : cross(from, Vector3(0.0, 1.0, 0.0));
  return normalized(Quaternion<double>{0.0, across[0], across[1], across[2]});
}

PALPATE_INLINE ToolState PortedShaft::at_tip(const ToolState& handle) noexcept {
  state_ = handle;
  const Vector3 to_port = port_.position - handle.position;
  const double distance = to_port.norm();
  if (!handle.valid || !std::isfinite(distance)) return handle;
  if (distance > 1e-9) direction_ = to_port / distance;
  outside_ = std::max(distance, least_outside());
  inside_ = port_.length - outside_;
  ToolState tip = handle;
  tip.position = port_.position + inside_ * direction_;
  tip.velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  const Quaternion<double> q = shortest_rotation(port_.shaft, direction_);
  tip.orientation = {q.w, q.x, q.y, q.z};
  return tip;
}

PALPATE_INLINE GatedForce PortedShaft::to_handle(const GatedForce& at_tip) noexcept {
  const Vector3 &f = at_tip.force(), &u = direction_;
  const double along = u.dot(f), ratio = inside_ / outside_;
  const Vector3 force = along * u - ratio * (f - along * u) - cross(at_tip.torque(), u) / outside_;
  return pass(force, Vector3(0.0, 0.0, 0.0), at_tip);
}

PALPATE_INLINE DeviceLimits PortedShaft::limits_at_tip() const noexcept {
  const double lever = std::max(1.0, port_.longest_lever), arm = least_outside();
  DeviceLimits tip = device_;
  tip.stiffness = device_.stiffness / (lever * lever);
  tip.peak_force = device_.peak_force / lever;
  tip.continuous_force = device_.continuous_force / lever;
  tip.peak_torque = device_.peak_force * arm;
  tip.rotational_stiffness = device_.stiffness * arm * arm;
  return tip;
}

/// The spring acts at the point of the axis that is nearest to the port, while that is between handle and tip.
PALPATE_INLINE GatedForce PortedShaft::with_port(const GatedForce& at_handle) noexcept {
  const auto& [w, x, y, z] = state_.orientation;
  const Vector3 axis = rotation_matrix({w, x, y, z}) * port_.shaft;
  const double along = axis.dot(port_.position - state_.position);
  Vector3 force = at_handle.force(), torque = at_handle.torque();
  deviation_ = 0.0;
  if (along > 0.0 && along < port_.length) {
    const Vector3 arm = along * axis, offset = state_.position + arm - port_.position;
    deviation_ = offset.norm();
    const Vector3 spring = -port_.stiffness * offset;
    force += spring;
    torque += cross(arm, spring);
  }
  return pass(force, torque, at_handle);
}

PALPATE_INLINE GatedForce PortedShaft::pass(const Vector3& force, const Vector3& torque,
                                            const GatedForce& given) noexcept {
  const double now = std::isfinite(state_.now) ? state_.now : state_.time;
  GatedForce passed = gate_.apply(force, torque, now, state_.time, state_.valid, false);
  passed.status |= given.status;
  passed.error = given.error;
  return passed;
}

PALPATE_INLINE void PortedShaft::reset() noexcept {
  gate_.reset();
  deviation_ = 0.0;
}

}  // namespace detail

}}  // namespace palpate
