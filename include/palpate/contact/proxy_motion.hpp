// Where proxies go in a tick.
#pragma once

#include <palpate/contact/contact.hpp>

#include <Eigen/Geometry>

#include <array>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// Moves the proxies of all tools: along with their devices, then from linearisation to linearisation to where the
/// answer has them. Says how far the next step goes and how much forces changed in the last. No allocation.
class ProxyMotion {
 public:
  using Tools = std::span<ContactTool>;
  /// How far the present force lets a proxy go.
  struct Ahead {
    Vector3 way = Vector3::Zero(),
            axis = Vector3::Zero();  ///< of the proxy; of the end of a capsule's axis of length 1
    double farthest = 0.0;           ///< way of any of its points, at most [m]
  };

  /// Takes the proxies along with their devices, across the contact force: from there the first linearisation is nearly
  /// right for a ball that slides.
  static void slide(Tools tools) noexcept {
    for (ContactTool& tool : tools) {
      const double force = tool.force.squaredNorm();
      if (!tool.active || force == 0.0 || tool.motion.norm() > 0.1 * tool.radius) continue;
      tool.proxy += tool.motion - (tool.force.dot(tool.motion) / force) * tool.force;
    }
  }

  /// Remembers the forces that a linearisation begins with.
  void begin(Tools tools) noexcept {
    for (std::size_t t = 0; t < tools.size(); ++t) {
      start_force_[t] = tools[t].force;
      start_torque_[t] = tools[t].torque;
    }
  }

  /// `floor`: the least compliance of a contact [m/N], as TissueModel has it.
  void look_ahead(Tools tools, double floor) noexcept {
    for (std::size_t t = 0; t < tools.size(); ++t) {
      const ContactTool& tool = tools[t];
      Ahead& ahead = ahead_[t];
      ahead.way = tool.goal(floor) - tool.proxy;
      ahead.farthest = ahead.way.norm();
      if (tool.half_length == 0.0) continue;
      ahead.axis = (tool.goal_rotation() - tool.rotation) * tool.own_axis;
      ahead.farthest += tool.half_length * ahead.axis.norm();
    }
  }
  const Ahead& ahead(std::size_t tool) const noexcept { return ahead_[tool]; }

  /// Moves the proxies to where the answer has them, as far as one linearisation may go; true when all are there.
  bool follow(Tools tools, double floor) noexcept {
    bool arrived = true;
    look_ahead(tools, floor);
    for (std::size_t t = 0; t < tools.size(); ++t) {
      ContactTool& tool = tools[t];
      if (!tool.active) continue;
      const double length = ahead_[t].farthest, longest = tool.longest_step();
      const double part = length <= longest ? 1.0 : longest / length;
      tool.proxy += part * ahead_[t].way;
      turn(tool, part);
      arrived = arrived && length <= longest;
    }
    return arrived;
  }

  /// Of the tools' forces and torques since `begin`.
  double relative_change(Tools tools) const noexcept {
    double change = 0.0, scale = 0.0;
    for (std::size_t t = 0; t < tools.size(); ++t) {
      change = std::max(change, (tools[t].force - start_force_[t]).norm());
      scale = std::max(scale, tools[t].force.norm());
      if (!(tools[t].half_length > 0.0)) continue;
      change = std::max(change, (tools[t].torque - start_torque_[t]).norm() / tools[t].half_length);
    }
    return change > 0.0 ? change / scale : 0.0;
  }

 private:
  static void turn(ContactTool& tool, double part) noexcept {
    const Matrix3 goal = tool.goal_rotation();
    if (part == 1.0) {
      tool.rotation = goal;
      return;
    }
    const Eigen::AngleAxisd by(Matrix3(goal * tool.rotation.transpose()));
    tool.rotation = Eigen::AngleAxisd(part * by.angle(), by.axis()) * tool.rotation;
  }

  std::array<Vector3, maximum_tools> start_force_{}, start_torque_{};
  std::array<Ahead, maximum_tools> ahead_{};
};

}}  // namespace palpate
