// Definitions of push_out.hpp.
#pragma once

#include <palpate/haptic/detail/push_out.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void PushOut::begin_tick(const ContactProblem& problem, ContactTool& tool, bool restarted) noexcept {
  status_ = {};
  if (!tool.active || restarted || moves_ != problem.moves()) forget();
  moves_ = problem.moves();
  if (!holds_) return;
  if (side_.dot(tool.target) >= level_) {
    holds_ = false;
    return;
  }
  limit(tool);
  tool.motion = tool.target - last_target_;
  last_target_ = tool.target;
  status_.set(StatusFlag::lost_contact);
}

PALPATE_INLINE bool PushOut::is_beside(const ContactTool& tool) const noexcept {
  const Vector3 path = tool.target - contact_.proxy;
  return holds_ && (path - side_.dot(path) * side_).norm() > 2.0 * tool.radius + tool.core_radius();
}

PALPATE_INLINE void PushOut::limit(ContactTool& tool) noexcept {
  tool.target += std::max(0.0, level_ - side_.dot(tool.target)) * side_;
}

PALPATE_INLINE bool PushOut::push_out(ContactProblem& problem, const TissueView& tissue,
                                      std::span<ContactTool> tools) noexcept {
  ContactTool& tool = tools[tool_];
  const bool first = !holds_;
  if (first) {
    side_ = contact_.force.normalized();
    level_ = side_.dot(contact_.proxy - contact_.total_compliance() * contact_.force) + step_back * tool.radius;
    held_push_ = contact_.force.norm();
  }
  holds_ = true;
  tool.proxy = contact_.proxy;
  tool.rotation = contact_.rotation;
  tool.force = contact_.force;
  tool.torque = contact_.torque;
  tool.local_compliance = contact_.local_compliance;
  tool.motion.setZero();
  limit(tool);
  last_target_ = tool.target;
  problem.restore(tissue, tools, tool_, {pressing_.data(), count_});
  status_.set(StatusFlag::lost_contact);
  return first;
}

/// Before a tool passes, the tissue pushes back less although the device goes on.
PALPATE_INLINE bool PushOut::is_right(const ContactTool& tool, bool converged) const noexcept {
  if (holds_) return converged && !has_given_way(tool);
  if (count_ == 0 || (tool.target - contact_.target).norm() > longest_path * tool.radius) return true;
  return converged && (!is_deeper(tool) || push_of(tool) >= push_of(contact_));
}

PALPATE_INLINE void PushOut::end_tick(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool,
                                      bool converged) noexcept {
  if (pressing_.empty()) return;
  if (!(tool.force.squaredNorm() > 0.0) || tool.grasping) return forget();
  if (!is_right(tool, converged)) return;
  if (problem.share_from_behind(tissue, tool_) > 0.0) {
    if (!knows_contact()) status_.set(StatusFlag::lost_contact);
    return;
  }
  revision_ = tissue.contact_surface().revision();
  contact_ = tool;
  count_ = problem.copy_pressing(tool_, pressing_);
}

}}  // namespace palpate
