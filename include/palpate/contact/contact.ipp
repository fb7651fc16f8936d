// Definitions of contact.hpp.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ContactParameters ContactParameters::for_tools(std::size_t tools, bool large_strain) const noexcept {
  ContactParameters p = *this;
  const int others = static_cast<int>(std::max<std::size_t>(tools, 1)) - 1;
  if (p.capacity == 0)
    p.capacity =
        (large_strain ? capacity_at_large_strain : 1) * (default_contact_capacity + default_capacity_per_tool * others);
  return p;
}
PALPATE_INLINE void ContactTool::lift() noexcept {
  active = grasping = false;
  force.setZero();
  torque.setZero();
  outward.setZero();
  entered = -infinity;
}
PALPATE_INLINE void ContactTool::reset() noexcept {
  ContactTool fresh;
  fresh.radius = radius;
  fresh.compliance = compliance;
  fresh.half_length = half_length;
  fresh.hull = hull;
  fresh.own_axis = own_axis;
  fresh.rotational_compliance = rotational_compliance;
  *this = fresh;
}
PALPATE_INLINE Vector3 ContactTool::goal(double floor) const noexcept {
  return target + (compliance + floor) * force;
}
PALPATE_INLINE Matrix3 ContactTool::goal_rotation() const noexcept {
  return rotational_compliance > 0.0 ? rotation_by(rotational_compliance * torque) * target_rotation : target_rotation;
}
PALPATE_INLINE Vector3 ContactTool::axis() const noexcept {
  return rotation * own_axis;
}
PALPATE_INLINE detail::CorePoint ContactTool::closest_extended(const Vector3& p) const noexcept {
  if (hull != nullptr) {
    const ConvexHull::Closest on = hull->closest(rotation.transpose() * (p - proxy));
    return {on.point, -(rotation * on.outward), on.distance};
  }
  const Vector3 direction = axis();
  const double along = along_capsule(p, direction);
  return from_core(p, proxy + along * direction, along * own_axis);
}
/// Where on the axis the cone is closest to `p`: the least of sine sqrt(d^2 + x^2) - cosine height, with x the way from
/// the point whose distance d across `outward` is least; the lower end where the axis is steeper than the cone.
PALPATE_INLINE double ContactTool::along_cone(const Vector3& p, const Vector3& direction) const noexcept {
  const double along = outward.dot(direction);
  const Vector3 across = direction - along * outward, offset = p - proxy - outward.dot(p - proxy) * outward;
  const double length = across.norm();
  if (!(cone_cosine * std::abs(along) < cone_sine * length)) return along > 0.0 ? -half_length : half_length;
  const double nearest = offset.dot(across) / (length * length), slope = -cone_cosine * along / (cone_sine * length);
  const double way = (offset - nearest * across).norm() * slope / std::sqrt(1.0 - slope * slope);
  return std::clamp(nearest + way / length, -half_length, half_length);
}
/// A tool that presses deeper than its radius would part the surface and pass, because linear tissue gives way to the
/// side. Material that it entered is therefore kept from its cap and from the cone that is tangent to it: no normal is
/// farther from `outward` than the rim of the cap. On plane tissue nothing is beyond that rim until the tool is about
/// a radius deep. A capsule has the cap and cone of a sphere at every point of its axis.
PALPATE_INLINE detail::CorePoint ContactTool::closest_pressed(const Vector3& p) const noexcept {
  const bool is_capsule = half_length > 0.0;
  const Vector3 direction = is_capsule ? axis() : Vector3(0.0, 0.0, 0.0);
  const auto core = [&](double along) -> Vector3 { return proxy + along * direction; };
  const double own_along = along_capsule(p, direction);
  const detail::CorePoint own = from_core(p, core(own_along), own_along * own_axis);
  if (own.normal.dot(outward) >= cone_cosine || outward.dot(p - core(own_along)) > entered) return own;
  const Vector3 from = core(is_capsule ? along_cone(p, direction) : 0.0);
  const double height = outward.dot(p - from);
  Vector3 aside = p - from - height * outward;
  const double distance = aside.norm();
  aside = distance > 0.0 ? Vector3(aside / distance) : outward.unitOrthogonal();
  const Vector3 normal = cone_cosine * outward - cone_sine * aside;
  const double along = cone_sine * distance - cone_cosine * height;
  const Vector3 point = p + along * normal - proxy;
  return {is_capsule ? Vector3(rotation.transpose() * point) : point, normal, along};
}
PALPATE_INLINE double ContactTool::height(const Vector3& p) const noexcept {
  const Vector3 direction = axis();
  return outward.dot(p - proxy - along_capsule(p, direction) * direction);
}
PALPATE_INLINE double ContactTool::cone_path(const Vector3& outward_before, double entered_before) const noexcept {
  const double begin = -cone_cosine * radius, now = std::max(begin, entered), before = std::max(begin, entered_before);
  if (!(std::max(now, before) > begin)) return 0.0;
  return (outward - outward_before).norm() * radius + 1.1 * std::abs(now - before);
}
PALPATE_INLINE double ContactTool::core_path(const Matrix3& change) const noexcept {
  if (half_length == 0.0) return 0.0;
  if (hull == nullptr) return half_length * (change * own_axis).norm();
  double square = 0.0;  // the two largest singular values of a difference of rotations are equal, the third is zero
  for (int i = 0; i < 9; ++i) square += change.data()[i] * change.data()[i];
  return half_length * std::sqrt(0.5 * square);
}
PALPATE_INLINE Vector3 ContactTool::middle() const noexcept {
  return hull == nullptr ? proxy : Vector3(proxy + rotation * hull->middle());
}
PALPATE_INLINE double ContactTool::path_length() const noexcept {
  return motion.norm() + end_path;
}
PALPATE_INLINE Vector3 Contact::total() const noexcept {
  return force * normal + friction;
}

}}  // namespace palpate
