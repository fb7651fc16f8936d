// Definitions of proxy_motion.hpp.
#pragma once

#include <palpate/contact/detail/proxy_motion.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

PALPATE_INLINE void ProxyMotion::begin(Tools tools, double floor) noexcept {
  clipped_ = false;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    ContactTool& tool = tools[t];
    // Shorter steps would keep a part of the forces of a tool that is gone.
    if (std::exchange(active_[t], tool.active) != tool.active) longest_part_ = 1.0;
    start_force_[t] = tool.force;
    start_torque_[t] = tool.torque;
    target_[t] = tool.target;
    const Vector3 path = tool.goal(floor) - tool.proxy;
    const double length = path.norm(), longest = tool.longest_step();
    if (!tool.active || !(length > longest)) continue;
    tool.target -= (1.0 - longest / length) * path;
    clipped_ = true;
  }
}

PALPATE_INLINE void ProxyMotion::end(Tools tools) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) tools[t].target = target_[t];
}

PALPATE_INLINE void ProxyMotion::look_ahead(Tools tools, double floor) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const ContactTool& tool = tools[t];
    Ahead& ahead = ahead_[t];
    ahead.path = tool.goal(floor) - tool.proxy;
    ahead.farthest = ahead.path.norm();
    if (tool.half_length == 0.0) continue;
    ahead.turn = tool.goal_rotation() - tool.rotation;
    ahead.farthest += tool.core_path(ahead.turn);
  }
}

/// The part of a step of length `path` that one linearisation may go.
inline double ProxyMotion::allowed_part(const ContactTool& tool, double path) noexcept {
  const double longest = tool.longest_step();
  return path > longest ? longest / path : 1.0;
}

PALPATE_INLINE double ProxyMotion::follow(Tools tools, double floor, double surface) noexcept {
  look_ahead(tools, floor);
  const auto is_free = [&](std::size_t t) {
    return start_force_[t].squaredNorm() == 0.0 && tools[t].force.squaredNorm() == 0.0;
  };
  double part = longest_part_;
  for (std::size_t t = 0; t < tools.size(); ++t)
    if (tools[t].active && !is_free(t))
      part = std::min(part, allowed_part(tools[t], std::max(surface, ahead_[t].farthest)));
  took_whole_step_ = took_whole_step_ || (part == longest_part_ && !clipped_);
  arrived_ = part == 1.0 && !clipped_;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    ContactTool& tool = tools[t];
    if (!tool.active) continue;
    const double own = is_free(t) ? allowed_part(tool, ahead_[t].farthest) : part;
    arrived_ = arrived_ && own == 1.0;
    tool.proxy += own * ahead_[t].path;
    rotate(tool, own);
    if (part == 1.0) continue;
    tool.force = start_force_[t] + part * (tool.force - start_force_[t]);
    tool.torque = start_torque_[t] + part * (tool.torque - start_torque_[t]);
  }
  return part;
}

PALPATE_INLINE double ProxyMotion::relative_change(Tools tools, double scale) const noexcept {
  double change = 0.0;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    change = std::max(change, (tools[t].force - start_force_[t]).norm());
    if (!(tools[t].half_length > 0.0)) continue;
    const double arm = std::max(tools[t].half_length, tools[t].radius);
    change = std::max(change, (tools[t].torque - start_torque_[t]).norm() / arm);
  }
  return change > 0.0 ? change / scale : 0.0;
}

/// Whether a tool rests, or moves on about as in the last tick, without a rotation.
inline ProxyMotion::Pace ProxyMotion::pace(const ContactTool& tool, const Last& last) noexcept {
  const Vector3 path = tool.target - last.target;
  if (!tool.active || std::max(path.norm(), tool.end_path) <= resting * tool.radius) return Pace::rests;
  const bool rotates = tool.end_path > resting * tool.radius;
  const double length = path.norm(), before = last.path.norm();
  const bool goes_on =
      path.dot(last.path) > 0.7 * length * before && std::max(length, before) < 1.5 * std::min(length, before);
  return goes_on && !rotates ? Pace::steady : Pace::other;
}

/// At rest a change must be opposite to the one before it twice in turn: a slip that rebounds, or a tick without a
/// reading, is so once. While tools move steadily forces change more, so it must be three times, by more.
PALPATE_INLINE bool ProxyMotion::alternates(Tools tools, double scale) noexcept {
  Pace pace_of_all = Pace::rests;
  for (std::size_t t = 0; t < tools.size(); ++t) pace_of_all = std::max(pace_of_all, pace(tools[t], last_[t]));
  const bool presses = scale > 0.0, same_pace = std::exchange(pace_, pace_of_all) == pace_of_all;
  const double least = (pace_of_all == Pace::rests ? alternating : alternating_in_motion) * scale;
  const int most_reversals = pace_of_all == Pace::rests ? 1 : 2;
  if (!presses) reported_ticks_ = 0;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    Last& last = last_[t];
    const Vector3 change = pace_of_all == Pace::other ? Vector3(Vector3::Zero()) : Vector3(tools[t].force - last.force);
    const bool reverses =
        presses && same_pace && std::min(change.norm(), last.change.norm()) > least && change.dot(last.change) < 0.0;
    last = {tools[t].force, tools[t].target, tools[t].target - last.target, change, reverses ? last.reversals + 1 : 0};
    if (last.reversals > most_reversals) reported_ticks_ = patience;
  }
  return reported_ticks_ > 0 && reported_ticks_-- > 0;
}

PALPATE_INLINE bool ProxyMotion::end_tick(Tools tools, bool converged, bool presses, double scale) noexcept {
  const bool moves = std::any_of(tools.begin(), tools.end(), [](const ContactTool& tool) {
    return tool.active && tool.path_length() > still * tool.radius;
  });
  if (moves || !presses) {
    longest_part_ = 1.0;
    restless_ticks_ = converged_ticks_ = 0;
    wait_ = first_wait;
  } else if (converged) {
    restless_ticks_ = 0;
    if (longest_part_ < 1.0 && ++converged_ticks_ >= wait_) {
      longest_part_ = std::min(1.0, 2.0 * longest_part_);
      converged_ticks_ = 0;
    }
  } else if (took_whole_step_ && ++restless_ticks_ >= patience) {
    restless_ticks_ = converged_ticks_ = 0;
    longest_part_ = std::max(least_part, 0.5 * longest_part_);
    wait_ = std::min(2 * wait_, longest_wait);
  }
  took_whole_step_ = false;
  return alternates(tools, scale);
}

}}}  // namespace palpate::detail
