// Definitions of trocar.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/servo_options.hpp>
#include <palpate/haptic/trocar.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void TrocarPort::require_valid() const {
  const auto is_positive = [](double v) { return v > 0.0 && v < infinity; };
  if (!(all_finite(position) && all_finite(shaft) && shaft.norm() > 0.0))
    raise(SetupErrorKind::bad_argument, "a port has no finite position, or its shaft no direction",
          "Give TrocarPort::shaft a length above zero");
  if (!(is_positive(length) && is_positive(longest_lever) && is_positive(stiffness) && is_positive(radius)))
    raise(SetupErrorKind::bad_argument, "length, lever, stiffness and radius of a port must be positive and finite");
}

namespace detail {

inline TrocarPort checked(TrocarPort port) {
  port.require_valid();
  port.shaft /= port.shaft.norm();
  return port;
}

inline void require_stiffness(double value, double most, const char* what, const char* unit) {
  if (value <= most) return;
  SetupProblem problem;
  problem.what = std::string("the stiffness of a port ") + what + " is " + number(value) + ' ' + unit +
                 ", the device renders " + number(most) + ' ' + unit + " stably";
  problem.hint = "Reduce TrocarPort::stiffness";
  problem.value = value;
  problem.threshold = most;
  raise(std::move(problem));
}

/// The rotation by the smallest angle from `from` to `to`, unit vectors; by a half turn about an axis across where they
/// are opposite.
inline Quaternion<double> shortest_rotation(const Vector3& from, const Vector3& to) noexcept {
  const Vector3 axis = cross(from, to);
  const double w = 1.0 + from.dot(to);
  if (w > 1e-9) return normalized(Quaternion<double>{w, axis[0], axis[1], axis[2]});
  const Vector3 other = std::abs(from[0]) < 0.9 ? Vector3(1.0, 0.0, 0.0) : Vector3(0.0, 1.0, 0.0);
  const Vector3 across = cross(from, other);
  return normalized(Quaternion<double>{0.0, across[0], across[1], across[2]});
}

PALPATE_INLINE PortedShaft::PortedShaft(const TrocarPort& port, const DeviceLimits& device, double rate)
    : port_(checked(port)),
      device_(device),
      gate_(device, rate),
      direction_(port_.shaft),
      outside_(0.5 * port_.length),
      inside_(0.5 * port_.length) {}

PALPATE_INLINE void PortedShaft::require_stable(double rate) const {
  require_stiffness(port_.stiffness, stable_at(rate, device_, device_.stiffness), "", "N/m");
  if (device_.peak_torque > 0.0)
    require_stiffness(about_handle(), stable_at(rate, device_, device_.rotational_stiffness), "about the handle",
                      "N m/rad");
}

PALPATE_INLINE void PortedShaft::take(const ToolState& handle) noexcept {
  gate_.take(handle);
  if (!handle.valid) has_direction_ = false;
}

/// The side of the port on which the handle is does not change: beyond the port it is at it.
PALPATE_INLINE ToolState PortedShaft::at_tip(const ToolState& handle) noexcept {
  const Vector3 to_port = port_.position - handle.position;
  double distance = to_port.norm();
  if (!handle.valid || !std::isfinite(distance)) return handle;
  if (has_direction_ && to_port.dot(direction_) <= 0.0)
    distance = 0.0;
  else if (distance > 1e-9)
    direction_ = to_port / distance, has_direction_ = true;
  outside_ = std::max(distance, least_outside());
  inside_ = port_.length - outside_;
  nearness_ = distance / outside_;
  ToolState tip = handle;
  tip.position = port_.position + inside_ * direction_;
  tip.velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  const Quaternion<double> q = shortest_rotation(port_.shaft, direction_);
  tip.orientation = {q.w, q.x, q.y, q.z};
  return tip;
}

PALPATE_INLINE GatedForce PortedShaft::to_handle(const GatedForce& at_tip) noexcept {
  if (lacks_state()) return {};
  const Vector3 &f = at_tip.force(), &u = direction_;
  const double along = u.dot(f), ratio = inside_ / outside_;
  const Vector3 force = along * u - ratio * (f - along * u) - cross(at_tip.torque(), u) / outside_;
  GatedForce at_handle = gate_.pass(nearness_ * force, Vector3(0.0, 0.0, 0.0), at_tip, false);
  if (nearness_ < 1.0) at_handle.status.set(StatusFlag::degraded_model);
  return at_handle;
}

/// Of what the handle renders with the longest lever, the coupling of the position has four fifths, that of the
/// rotation the rest.
PALPATE_INLINE DeviceLimits PortedShaft::limits_at_tip() const noexcept {
  constexpr double part = 0.8;
  const double lever = std::max(1.0, port_.longest_lever), arm = least_outside();
  DeviceLimits tip = device_;
  tip.stiffness = part * device_.stiffness / (lever * lever);
  tip.peak_torque = device_.peak_force * arm;
  tip.rotational_stiffness = (1.0 - part) * device_.stiffness * arm * arm;
  return tip;
}

PALPATE_INLINE DeviceLimits PortedShaft::limits_beside_port() const noexcept {
  constexpr double least_part = 0.1;
  DeviceLimits left = device_;
  left.stiffness = std::max(least_part * device_.stiffness, device_.stiffness - port_.stiffness);
  left.rotational_stiffness =
      std::max(least_part * device_.rotational_stiffness, device_.rotational_stiffness - about_handle());
  return left;
}

/// The spring acts at the point of the axis that is nearest to the port, while that is between handle and tip. The
/// force ramps up when the shaft enters.
PALPATE_INLINE GatedForce PortedShaft::with_port(const GatedForce& at_handle) noexcept {
  if (lacks_state()) return {};
  const ToolState& handle = gate_.state();
  const auto& [w, x, y, z] = handle.orientation;
  const Vector3 axis = rotation_matrix({w, x, y, z}) * port_.shaft;
  const double along = axis.dot(port_.position - handle.position);
  const Vector3 arm = along * axis, offset = handle.position + arm - port_.position;
  const bool was_in_port = in_port_;
  in_port_ = handle.valid && along > 0.0 && along < port_.length && (was_in_port || offset.norm() <= port_.radius);
  deviation_ = in_port_ ? offset.norm() : 0.0;
  Vector3 force = at_handle.force(), torque = at_handle.torque();
  if (in_port_) {
    const Vector3 spring = -port_.stiffness * offset;
    force += spring;
    torque += cross(arm, spring);
  }
  return gate_.pass(force, torque, at_handle, in_port_ != was_in_port);
}

PALPATE_INLINE bool PortedShaft::lacks_state() noexcept {
  if (!gate_.lacks_state()) return false;
  reset();
  return true;
}

PALPATE_INLINE void PortedShaft::reset() noexcept {
  gate_.reset();
  deviation_ = 0.0;
  nearness_ = 1.0;
  has_direction_ = in_port_ = false;
}

}  // namespace detail

}}  // namespace palpate
