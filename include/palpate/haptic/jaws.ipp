// Definitions of jaws.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/jaws.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void JawJoint::require_valid() const {
  const auto is_positive = [](double v) { return v > 0.0 && v < infinity; };
  if (!(all_finite(pivot) && all_finite(axis) && axis.norm() > 0.0))
    raise(SetupErrorKind::bad_argument, "the joint of jaws has no axis or no finite pivot",
          "Give JawJoint::axis a length above zero");
  if (!(is_positive(widest) && widest < 3.0))
    raise(SetupErrorKind::bad_argument, "the widest opening of jaws is " + number(widest) + " rad",
          "It must be above 0 and below 3 rad");
  if (!(is_positive(grip_force) && is_positive(grip_torque) && is_positive(stiffness)))
    raise(SetupErrorKind::bad_argument, "force, torque and stiffness of a joint must be positive and finite");
}

PALPATE_INLINE ButtonOpening::ButtonOpening(std::uint32_t buttons, double widest, double speed)
    : buttons_(buttons), widest_(widest), speed_(speed), opening_(widest) {
  if (!(widest > 0.0 && widest < 3.0 && speed > 0.0 && speed < infinity))
    raise(SetupErrorKind::bad_argument, "jaws that open by " + number(widest) + " rad at " + number(speed) + " rad/s",
          "Both must be positive");
}

PALPATE_INLINE double ButtonOpening::operator()(const ToolState& state) noexcept {
  constexpr double longest = 0.05;  // [s] between two states
  const double seconds = std::clamp(state.time - time_, 0.0, longest);
  time_ = state.time;
  if (!state.valid || !(seconds > 0.0)) return opening_;
  const double step = seconds * speed_;
  opening_ = std::clamp(opening_ + ((state.buttons & buttons_) != 0 ? -step : step), 0.0, widest_);
  return opening_;
}

namespace detail {

inline JawJoint checked(JawJoint joint) {
  joint.require_valid();
  joint.axis /= joint.axis.norm();
  return joint;
}

PALPATE_INLINE JawPair::JawPair(const JawJoint& joint, const DeviceLimits& device, double rate)
    : joint_(checked(joint)), device_(device), gate_(device, rate), opening_(joint.widest) {}

PALPATE_INLINE void JawPair::take(const ToolState& state, double opening) noexcept {
  gate_.take(state);
  if (!std::isnan(opening)) opening_ = std::clamp(opening, 0.0, joint_.widest);  // else the last one
}

PALPATE_INLINE ToolState JawPair::state(double side) const noexcept {
  ToolState s = gate_.state();
  const auto [w, x, y, z] = s.orientation;
  const Quaternion<double> handle{w, x, y, z};
  const Quaternion<double> q = handle * quaternion_by(Vector3(0.5 * side * opening_ * joint_.axis));
  s.position += rotation_matrix(handle) * joint_.pivot;
  s.velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  s.orientation = {q.w, q.x, q.y, q.z};
  return s;
}

PALPATE_INLINE DeviceLimits JawPair::limits() const noexcept {
  DeviceLimits jaw = device_;
  jaw.stiffness = 0.5 * device_.stiffness;
  jaw.peak_force = jaw.continuous_force = joint_.grip_force;
  jaw.peak_torque = joint_.grip_torque;
  jaw.rotational_stiffness = joint_.stiffness;
  if (device_.peak_torque > 0.0)
    jaw.rotational_stiffness = std::min(joint_.stiffness, 0.5 * device_.rotational_stiffness);
  return jaw;
}

/// Torques of the jaws are about the pivot.
PALPATE_INLINE GatedForce JawPair::sum() noexcept {
  joint_torque_ = 0.0;
  if (gate_.lacks_state()) return {};
  const auto& [w, x, y, z] = gate_.state().orientation;
  const Matrix3 handle = rotation_matrix({w, x, y, z});
  const Vector3 force = force_[0].force() + force_[1].force();
  const Vector3 torque = force_[0].torque() + force_[1].torque() + cross(handle * joint_.pivot, force);
  const double apart = 0.5 * (handle * joint_.axis).dot(force_[0].torque() - force_[1].torque());
  if (std::isfinite(apart)) joint_torque_ = apart;
  GatedForce given = force_[0].error.bound < force_[1].error.bound ? force_[1] : force_[0];
  given.status = force_[0].status | force_[1].status;
  return gate_.pass(force, torque, given, false);
}

PALPATE_INLINE void JawPair::reset() noexcept {
  gate_.reset();
  force_ = {};
  joint_torque_ = 0.0;
}

}  // namespace detail

}}  // namespace palpate
