// Definitions of contact_rows.hpp: correction of the normals.
#pragma once

#include <palpate/contact/detail/contact_rows.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate
