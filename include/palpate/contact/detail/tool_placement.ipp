// Definitions of tool_placement.hpp.
#pragma once

#include <palpate/contact/detail/hull_placement.hpp>
#include <palpate/contact/detail/sweep.hpp>
#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Centres of the spheres that represent a capsule in queries of single points: the ends, and between them at most a
/// radius apart. Calls look(coordinate on the axis from the middle [m]) for each.
template <class Look>
void for_each_sphere(const ContactTool& tool, Look&& look) {
  if (tool.half_length == 0.0) {
    look(0.0);
    return;
  }
  const int n = 2 * static_cast<int>(std::ceil(tool.half_length / tool.radius));
  for (int k = 0; k <= n; ++k) look(tool.half_length * (2.0 * k / n - 1.0));
}

}  // namespace detail

PALPATE_INLINE void place_beside(ContactTool& tool, const ContactSurface& surface, const Vector3& position) noexcept {
  tool.force.setZero();
  tool.torque.setZero();
  tool.rotation = tool.target_rotation;
  tool.proxy = position;
  if (tool.hull != nullptr) return place_hull_beside(tool, surface);
  const Vector3 axis = tool.axis();
  for (int round = 0; round < (tool.half_length > 0.0 ? 4 : 1); ++round) {
    Vector3 move = Vector3::Zero();
    double deepest = tool.radius;
    detail::for_each_sphere(tool, [&](double s) {
      const Vector3 centre = tool.proxy + s * axis;
      const auto closest = surface.closest_of_body(centre);
      if (closest.distance >= deepest) return;
      deepest = closest.distance;
      move = closest.point + tool.radius * closest.outward - centre;
    });
    if (!(deepest < tool.radius)) return;
    tool.proxy += move;
  }
}

PALPATE_INLINE void sweep(ContactTool& tool, const ContactSurface& surface, const Vector3& from,
                          const Vector3& position) noexcept {
  const Vector3 path = position - from, axis = tool.axis(), turn = tool.target_rotation * tool.own_axis - axis;
  double part = 1.0;
  if (tool.hull != nullptr)
    part = first_touch(tool, surface, from, position);
  else
    detail::for_each_sphere(tool, [&](double s) {  // smaller, so that a touching sphere that moves away has no hit
      part = std::min(part, first_touch(surface, from + s * axis, path + s * turn, (1.0 - 1e-6) * tool.radius));
    });
  tool.proxy = from + part * path;
  const Vector3 by = rotation_vector(tool.target_rotation * tool.rotation.transpose());
  tool.rotation = part < 1.0 ? rotation_by(part * by) * tool.rotation : tool.target_rotation;
  tool.force.setZero();
  tool.torque.setZero();
}

}}  // namespace palpate
