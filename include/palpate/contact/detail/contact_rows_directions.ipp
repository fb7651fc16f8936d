// Definitions of contact_rows.hpp: directions of the forces, by friction and by corrected normals.
#pragma once

#include <palpate/contact/coulomb_friction.ipp>  // inline functions, as of the next
#include <palpate/contact/detail/candidates.ipp>
#include <palpate/contact/detail/contact_rows.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A point at the rim of a contact may press in every other tick: while its tool presses, it keeps its anchor over one
/// tick without force. With a new anchor each time, its friction force would come and go, and with it the normal
/// forces.
inline bool ContactRows::sticks(const Candidate& c) const noexcept {
  if (c.stuck_tick == 0) return false;
  return c.stuck_tick + 1 == tick_ || (c.stuck_tick + 2 == tick_ && pressed_tick_[at(c.tool)] + 1 == tick_);
}

PALPATE_INLINE void ContactRows::inherit_friction(const ContactTool& tool, Candidate& c) const noexcept {
  if (!friction_.acts() || sticks(c)) return;
  const Candidate* nearest = nullptr;
  for (int i = 0; i < count_; ++i) {
    const Candidate& other = *candidate_[at(i)];
    if (other.tool != c.tool || other.grasped || !sticks(other)) continue;
    if (nearest == nullptr || (other.point - c.point).squaredNorm() < (nearest->point - c.point).squaredNorm())
      nearest = &other;
  }
  if (nearest == nullptr) return;
  c.anchor = nearest->anchor + tool.rotation.transpose() * (c.point - nearest->point);
  c.friction.setZero();
  c.stuck_tick = nearest->stuck_tick;
}

/// The contact of row i for CoulombFriction, and its tangents.
PALPATE_INLINE void ContactRows::set_friction(const ContactTool& tool, int i) noexcept {
  const Candidate& c = *candidate_[at(i)];
  const Contact& row = rows_[at(i)];
  const Vector3 drift = tool.target + tool.target_rotation * c.anchor - row.rest;
  friction_.set(i, row.normal, drift, c.friction, !c.grasped && sticks(c));
  const auto [first, second] = friction_.tangents(i);
  stored_.set_axis(i, RowCompliance::first_tangent, first);
  stored_.set_axis(i, RowCompliance::second_tangent, second);
}

/// Gaps without normal forces, with the present friction forces.
inline void ContactRows::update_gaps() noexcept {
  for (int i = 0; i < count_; ++i) problem_.b[at(i)] = free_gap_[at(i)] + friction_.normal_displacement(i);
}

PALPATE_INLINE bool ContactRows::slide() noexcept {
  const int most = std::clamp(alternation_work / (count_ * count_), least_alternations, maximum_alternations);
  bool solved = true;
  std::copy_n(problem_.lambda.begin(), count_, pressed_.begin());
  for (int k = 0; k < most; ++k) {
    const bool friction_changed = friction_.improve();
    update_gaps();
    solved = problem_.solve_again();
    const double part = k < full_alternations ? 1.0 : 0.5;
    double change = 0.0, largest = 0.0;
    for (int i = 0; i < count_; ++i) {
      const double force = problem_.lambda[at(i)], own = force - pressed_[at(i)];
      change = std::max(change, std::abs(own));
      largest = std::max(largest, std::abs(force));
      pressed_[at(i)] += part * own;
    }
    friction_.press(pressed_.data());
    alternation_change_ = largest > 0.0 ? change / largest : 0.0;
    if (!friction_changed && !(alternation_change_ > alternation_tolerance)) break;
  }
  friction_.press(problem_.lambda.data());
  return solved;
}

PALPATE_INLINE void ContactRows::stick(std::span<const ContactTool> tools) noexcept {
  // A tick converges to a tolerance: a point that slips may end slightly within its disc. With its old anchor it would
  // stick in the next tick. A point that sticks so close to slipping loses nothing by a new anchor.
  constexpr double slipping = 0.99;
  if (!friction_.acts()) return;
  for (int i = 0; i < count_; ++i) {
    Candidate& c = *candidate_[at(i)];
    if (c.grasped || !(c.force > 0.0)) continue;
    const bool slips = has_converged() && !(c.friction.norm() < slipping * friction_.coefficient() * c.force);
    const bool kept = sticks(c) && !slips;
    const ContactTool& tool = tools[at(c.tool)];
    if (!kept) c.anchor = tool.rotation.transpose() * (rows_[at(i)].point - tool.proxy);
    c.stuck_tick = tick_;
    pressed_tick_[at(c.tool)] = tick_;
  }
}

PALPATE_INLINE double ContactRows::remaining_change(std::span<const ContactTool> tools) noexcept {
  if (remaining_change_ < 0.0) remaining_change_ = estimate_change(tools);
  return remaining_change_;
}

PALPATE_INLINE double ContactRows::estimate_change(std::span<const ContactTool> tools) noexcept {
  if (friction_.acts()) return infinity;
  redirected_of_tool_.fill(Vector3::Zero());
  double gap = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Contact& row = rows_[at(i)];
    const ContactTool& tool = tools[at(row.tool)];
    if (row.grasped || tool.half_length > 0.0) return infinity;
    redirected_[at(i)].setZero();
    if (row.force == 0.0) continue;
    const Vector3 arm = tool.goal(floor_) - row.point;
    const double distance = arm.norm();
    redirected_[at(i)] = row.force * (arm / distance - row.normal);
    redirected_of_tool_[at(row.tool)] += redirected_[at(i)];
    gap = std::max(gap, std::abs(distance - tool.radius));
  }
  double largest_change = 0.0;
  for (std::size_t t = 0; t < tools.size(); ++t)
    largest_change = std::max(largest_change, redirected_of_tool_[t].norm());
  const double largest_force = largest_force_scale(tools), push = deepest_push();
  return largest_force > 0.0 && push > 0.0 ? largest_change / largest_force + gap / push : infinity;
}

/// The redirected forces move points and proxies, which rotates the normals further. The ratio of the two rotations,
/// averaged over the rows, extrapolates the normals to their fixed point.
PALPATE_INLINE bool ContactRows::correct_normals(std::span<const ContactTool> tools) noexcept {
  const auto relative_path = [&](const ContactTool& tool, int i) -> Vector3 {
    return (tool.compliance + floor_) * redirected_of_tool_[at(rows_[at(i)].tool)] + moved_[i];
  };
  for (int i = 0; i < count_; ++i) forces_.set(i, redirected_[at(i)]);
  forces_.pad(count_);
  stored_.displace(count_, count_, forces_, moved_);
  double back = 0.0, changed = 0.0;
  for (int i = 0; i < count_; ++i) {
    if (rows_[at(i)].force == 0.0) continue;
    const ContactTool& tool = tools[at(rows_[at(i)].tool)];
    back += redirected_[at(i)].dot(relative_path(tool, i)) / tool.radius;
    changed += redirected_[at(i)].squaredNorm() / rows_[at(i)].force;
  }
  const double ratio = changed > 0.0 ? std::clamp(back / changed, 0.0, 0.75) : 0.0;
  const double factor = 1.0 / (1.0 - ratio);
  for (int i = 0; i < count_; ++i) {
    Contact& row = rows_[at(i)];
    const ContactTool& tool = tools[at(row.tool)];
    const Vector3 arm = tool.goal(floor_) - row.point;
    problem_.b[at(i)] += (arm + factor * relative_path(tool, i)).norm() - tool.radius - problem_.gap(i);
    row.normal = (row.normal + factor * (arm.normalized() - row.normal)).normalized();
    row.arm = -tool.radius * row.normal;
    candidate_[at(i)]->history.used = row.normal;
  }
  return problem_.solve_again();
}

}}}  // namespace palpate::detail
