// Definitions of push_out.hpp.
#pragma once

#include <palpate/haptic/detail/push_out.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Whether a position is behind the surface as forces deform it.
inline bool is_inside(ContactProblem& problem, const TissueView& tissue, const Vector3& position) noexcept {
  const double distance = std::abs(tissue.contact_surface().closest(position).distance);
  return problem.closest(tissue, position, distance).distance < 0.0;
}

}  // namespace detail

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

PALPATE_INLINE double PushOut::retreat_of(const ContactTool& tool) const noexcept {
  return contact_.force.dot(tool.target - contact_.target) / contact_.force.norm();
}

PALPATE_INLINE double PushOut::push_of(const ContactTool& tool) const noexcept {
  return contact_.force.dot(tool.force) / contact_.force.norm();
}

PALPATE_INLINE bool PushOut::has_passed(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool,
                                        bool converged) const noexcept {
  if (!tool.active || tool.grasping || count_ == 0) return false;
  if (holds_ && side_.dot(tool.force) < least_held * held_push_) return true;
  if (!(tool.force.squaredNorm() > 0.0))
    return revision_ == tissue.contact_surface().revision() && tissue.contact_surface().is_inside(tool.proxy) &&
           (problem.vertex_forces().empty() || detail::is_inside(problem, tissue, tool.proxy));
  if (problem.share_from_behind(tissue, tool_) > least_share) return true;
  if (!(push_of(tool) < least_push * contact_.force.norm())) return false;
  return (!converged && retreat_of(tool) < 0.0) || detail::is_inside(problem, tissue, tool.proxy);
}

/// Before a tool passes, the tissue pushes back less although the device does not retreat. Such a contact is right only
/// where the tool is outside.
PALPATE_INLINE bool PushOut::is_right(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool,
                                      bool converged) noexcept {
  if (holds_ && !converged) return false;
  const double force = tool.force.norm(), push = count_ > 0 ? push_of(tool) : force;
  const double path = (tool.target - contact_.target).norm();
  if (count_ == 0 || retreat_of(tool) > 0.5 * path) {
    certain_ = force;
    return true;
  }
  if (!converged && push < contact_.force.norm() && path < longest_path * tool.radius) return false;
  if (push < certain * certain_) {
    if (detail::is_inside(problem, tissue, tool.proxy)) return false;
    certain_ = force;
  }
  certain_ = std::max(certain_, force);
  return true;
}

PALPATE_INLINE void PushOut::end_tick(ContactProblem& problem, const TissueView& tissue, const ContactTool& tool,
                                      bool converged) noexcept {
  if (pressing_.empty()) return;
  if (!(tool.force.squaredNorm() > 0.0) || tool.grasping) return forget();
  if (problem.share_from_behind(tissue, tool_) > 0.0) {
    if (count_ == 0) status_.set(StatusFlag::lost_contact);
    return;
  }
  if (!is_right(problem, tissue, tool, converged)) return;
  revision_ = tissue.contact_surface().revision();
  contact_ = tool;
  count_ = problem.copy_pressing(tool_, pressing_);
}

}}  // namespace palpate
