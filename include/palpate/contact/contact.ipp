// Definitions of contact.hpp.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void ContactTool::lift() noexcept {
  active = grasping = false;
  force.setZero();
  torque.setZero();
}
PALPATE_INLINE void ContactTool::reset() noexcept {
  ContactTool fresh;
  fresh.radius = radius;
  fresh.compliance = compliance;
  fresh.half_length = half_length;
  fresh.own_axis = own_axis;
  fresh.rotational_compliance = rotational_compliance;
  *this = fresh;
}
PALPATE_INLINE Vector3 ContactTool::goal(double floor) const noexcept {
  return target + (total_compliance() + floor) * force;
}
PALPATE_INLINE Vector3 ContactTool::position() const noexcept {
  return proxy - local_compliance * force;
}
PALPATE_INLINE Matrix3 ContactTool::goal_rotation() const noexcept {
  return rotational_compliance > 0.0 ? rotation_by(rotational_compliance * torque) * target_rotation : target_rotation;
}
PALPATE_INLINE Vector3 ContactTool::axis() const noexcept {
  return rotation * own_axis;
}
PALPATE_INLINE double ContactTool::along_capsule(const Vector3& p) const noexcept {
  return std::clamp(axis().dot(p - proxy), -half_length, half_length);
}
PALPATE_INLINE double ContactTool::path_length() const noexcept {
  return motion.norm() + end_path;
}
PALPATE_INLINE Vector3 Contact::total() const noexcept {
  return force * normal + friction;
}

}}  // namespace palpate
