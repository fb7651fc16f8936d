// Definitions of proxy_motion.hpp.
#pragma once

#include <palpate/contact/detail/proxy_motion.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void ProxyMotion::rotate(ContactTool& tool, double part) noexcept {
  const Matrix3 goal = tool.goal_rotation();
  if (part == 1.0) {
    tool.rotation = goal;
    return;
  }
  tool.rotation = rotation_by(part * rotation_vector(goal * tool.rotation.transpose())) * tool.rotation;
}

PALPATE_INLINE void ProxyMotion::slide(Tools tools) noexcept {
  for (ContactTool& tool : tools) {
    const double force = tool.force.squaredNorm();
    if (!tool.active || force == 0.0 || tool.motion.norm() > 0.1 * tool.radius) continue;
    tool.proxy += tool.motion - (tool.force.dot(tool.motion) / force) * tool.force;
  }
}

PALPATE_INLINE void ProxyMotion::begin(Tools tools) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    start_force_[t] = tools[t].force;
    start_torque_[t] = tools[t].torque;
  }
}

PALPATE_INLINE void ProxyMotion::look_ahead(Tools tools, double floor) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const ContactTool& tool = tools[t];
    Ahead& ahead = ahead_[t];
    ahead.path = tool.goal(floor) - tool.proxy;
    ahead.farthest = ahead.path.norm();
    if (tool.half_length == 0.0) continue;
    ahead.axis = (tool.goal_rotation() - tool.rotation) * tool.own_axis;
    ahead.farthest += tool.half_length * ahead.axis.norm();
  }
}

PALPATE_INLINE bool ProxyMotion::follow(Tools tools, double floor) noexcept {
  bool arrived = true;
  look_ahead(tools, floor);
  for (std::size_t t = 0; t < tools.size(); ++t) {
    ContactTool& tool = tools[t];
    if (!tool.active) continue;
    const double length = ahead_[t].farthest, longest = tool.longest_step();
    const double part = length <= longest ? 1.0 : longest / length;
    tool.proxy += part * ahead_[t].path;
    rotate(tool, part);
    arrived = arrived && length <= longest;
  }
  return arrived;
}

PALPATE_INLINE double ProxyMotion::relative_change(Tools tools) const noexcept {
  double change = 0.0, scale = 0.0;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    change = std::max(change, (tools[t].force - start_force_[t]).norm());
    scale = std::max(scale, tools[t].force.norm());
    if (!(tools[t].half_length > 0.0)) continue;
    change = std::max(change, (tools[t].torque - start_torque_[t]).norm() / tools[t].half_length);
  }
  return change > 0.0 ? change / scale : 0.0;
}

}}  // namespace palpate
