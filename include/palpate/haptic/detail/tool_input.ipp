// Definitions of tool_input.hpp.
#pragma once

#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/detail/tool_input.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void ToolInput::receive(const ToolState& state, const Eigen::Isometry3d& pose,
                                       const ContactSurface& surface, std::span<const Contact> contacts,
                                       ContactTool& tool) noexcept {
  tool.motion.setZero();
  tool.end_path = 0.0;
  if (!state.valid) lose_reading(contacts, tool);
  Pose taken{position_, {1.0, 0.0, 0.0, 0.0}};
  if (!accept(state, pose, taken)) return;
  const bool pressed = (state.buttons & grasp_buttons_) != 0;
  needs_press_ = needs_press_ && pressed;
  tool.grasping = pressed && !needs_press_;
  if (rotates_) rotate(taken.orientation, pose, tool);
  follow(taken.position, surface, contacts, tool);
}

PALPATE_INLINE void ToolInput::receive_freely(const ToolState& state, const Eigen::Isometry3d& pose,
                                              double longest) noexcept {
  if (!state.valid) known_ = Known::nothing;
  Pose taken{position_, {1.0, 0.0, 0.0, 0.0}};
  if (!accept(state, pose, taken)) return;
  const bool jumped = known_ == Known::position && (taken.position - position_).norm() > longest;
  if (jumped) status_.set(StatusFlag::reacquired);
  if (jumped || known_ != Known::position) reading_ = Reading::restarted;
  position_ = taken.position;
  known_ = Known::position;
}

PALPATE_INLINE bool ToolInput::accept(const ToolState& state, const Eigen::Isometry3d& pose, Pose& taken) noexcept {
  status_ = {};
  reading_ = state.valid ? Reading::continued : Reading::unreadable;
  now_ = state.now;
  rotation_.setZero();
  if (!state.valid) return false;
  taken.position = inverse(pose) * state.position;
  if (rotates_) {
    const auto& q = state.orientation;
    taken.orientation = {q[0], q[1], q[2], q[3]};
  }
  if (!is_sound(taken.position, taken.orientation, state.time)) {
    // The last valid pose is kept; its old time stamp makes the gate fade the force.
    status_.set(StatusFlag::non_finite_input);
    if (known_ != Known::position) reading_ = Reading::unreadable;
    return false;
  }
  time_ = state.time;
  return true;
}

PALPATE_INLINE void ToolInput::note_tissue(bool has_news) noexcept {
  const bool was_readable = std::exchange(was_readable_, readable());
  const bool returned = readable() && !was_readable;  // the tool's time stood still meanwhile
  if (has_news || returned || !(news_ <= time_)) news_ = time_;
}

PALPATE_INLINE void ToolInput::set_clearance(std::uint64_t revision, const Vector3& position,
                                             double distance) noexcept {
  clear_revision_ = revision;
  clear_position_ = position;
  clearance_ = distance;
}

PALPATE_INLINE void ToolInput::note_outside(std::span<const Contact> contacts, const ContactTool& tool) noexcept {
  outside_.reset();
  if (tool.active) outside_ = {off_surface(contacts, tool), tool.rotation};
}

PALPATE_INLINE bool ToolInput::sweep_from_outside(const ContactSurface& surface, ContactTool& tool) noexcept {
  if (!outside_) return false;
  tool.rotation = outside_->rotation;
  sweep(tool, surface, outside_->position, position_);
  outside_.reset();
  return true;
}

PALPATE_INLINE void ToolInput::lose() noexcept {
  known_ = Known::nothing;
  outside_.reset();
  needs_press_ = true;
  status_.set(StatusFlag::reacquired);
}

/// Keeps the proxy for the next reading, moved out by the depth of the dent, which springs back without the force.
PALPATE_INLINE void ToolInput::lose_reading(std::span<const Contact> contacts, ContactTool& tool) noexcept {
  if (known_ == Known::position) {
    tool.proxy = off_surface(contacts, tool);
    known_ = Known::proxy;
  }
  needs_press_ = true;
  tool.lift();
}

PALPATE_INLINE void ToolInput::reset() noexcept {
  *this = ToolInput(number_, rotates_, grasp_buttons_);
}

PALPATE_INLINE bool ToolInput::is_sound(const Vector3& position, const Quaternion<double>& orientation,
                                        double time) noexcept {
  const double length = std::sqrt(orientation.w * orientation.w + orientation.x * orientation.x +
                                  orientation.y * orientation.y + orientation.z * orientation.z);
  return all_finite(position) && max_abs(position) < 1e6 && std::isfinite(time) && length > 0.5 && length < 2.0;
}

PALPATE_INLINE void ToolInput::rotate(const Quaternion<double>& orientation, const Eigen::Isometry3d& pose,
                                      ContactTool& tool) noexcept {
  const Matrix3 rotation = palpate::rotation_of(pose).transpose() * rotation_matrix(orientation);
  if (known_ == Known::position) {
    rotation_ = palpate::rotation_of(pose) * rotation_vector(rotation * tool.target_rotation.transpose());
    tool.end_path = tool.core_path(rotation - tool.target_rotation);
  }
  tool.target_rotation = rotation;
}

PALPATE_INLINE void ToolInput::follow(const Vector3& position, const ContactSurface& surface,
                                      std::span<const Contact> contacts, ContactTool& tool) noexcept {
  const Vector3 motion = position - position_;
  const bool leaps = known_ == Known::position && motion.norm() + tool.end_path > 2.0 * tool.radius;
  if (leaps || known_ != Known::position) reading_ = Reading::restarted;
  if (leaps || known_ == Known::proxy) {
    sweep(tool, surface, leaps ? off_surface(contacts, tool) : tool.proxy, position);
    tool.end_path = 0.0;
    tool.grasping = false;
    needs_press_ = true;
    status_.set(StatusFlag::reacquired);
  } else if (known_ == Known::nothing) {
    place_beside(tool, surface, position);
  } else {
    tool.motion = motion;
    // A proxy that nothing presses any more, but that is not where the device was yet: it need not go there in steps.
    if (tool.force.squaredNorm() == 0.0 && (position_ - tool.proxy).norm() > 0.5 * tool.radius)
      sweep(tool, surface, tool.proxy, position);
  }
  position_ = tool.target = position;
  known_ = Known::position;
  tool.active = true;
}

PALPATE_INLINE Vector3 ToolInput::off_surface(std::span<const Contact> contacts,
                                              const ContactTool& tool) const noexcept {
  const double force = tool.force.norm();
  if (!(force > 0.0)) return tool.proxy;
  double dent = 0.0;
  for (const Contact& c : contacts)
    if (c.tool == number_ && c.force > 0.0) dent = std::max(dent, (c.rest - c.point).dot(tool.force) / force);
  return tool.proxy + (dent / force) * tool.force;
}

}}}  // namespace palpate::detail
