// Definitions of tick_view.hpp.
#pragma once

#include <palpate/contact/blade_cut.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/detail/hand.hpp>
#include <palpate/haptic/detail/touched_tissue.hpp>
#include <palpate/haptic/tick_view.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// The tissue that a tool presses most.
PALPATE_INLINE const detail::TouchedTissue& TickView::pressed(std::size_t tool) const noexcept {
  return tissues_[hands_[tool].tissue];
}
PALPATE_INLINE int TickView::contact_rows() const noexcept {
  std::size_t rows = 0;
  for (const detail::TouchedTissue& tissue : tissues_) rows += tissue.problem().contacts().size();
  return static_cast<int>(rows);
}
PALPATE_INLINE double TickView::missing_depth() const noexcept {
  double most = 0.0;
  for (const detail::TouchedTissue& tissue : tissues_) most = std::max(most, tissue.problem().missing_depth());
  return most;
}
PALPATE_INLINE ForceError TickView::force_error(std::size_t tool) const noexcept {
  return hands_[tool].error;
}
PALPATE_INLINE double TickView::indentation(std::size_t tool) const noexcept {
  return pressed(tool).problem().indentation(tool, pressed(tool).touch(tool).tool);
}
PALPATE_INLINE bool TickView::is_holding(std::size_t tool) const noexcept {
  bool holds = false;
  for (const detail::TouchedTissue& tissue : tissues_) holds = holds || tissue.problem().is_holding(tool);
  return holds;
}
PALPATE_INLINE const BladeCut* TickView::blade(std::size_t tool, std::size_t tissue) const noexcept {
  const auto& blade = tissues_[tissue].touch(tool).blade;
  return blade ? &blade->cut() : nullptr;
}
PALPATE_INLINE Status TickView::tissue_status(std::size_t tissue) const noexcept {
  return tissues_[tissue].news() | tissues_[tissue].solved();
}
PALPATE_INLINE const EnergyTank* TickView::energy(std::size_t tool) const noexcept {
  return hands_[tool].tank ? &*hands_[tool].tank : nullptr;
}
PALPATE_INLINE Vector3 TickView::proxy(std::size_t tool) const noexcept {
  const detail::Touch& touch = pressed(tool).touch(tool);
  return touch.blade ? touch.blade->cut().edge() : Vector3(pressed(tool).view().to_world() * touch.tool.proxy);
}
PALPATE_INLINE Vector3 TickView::proxy_axis(std::size_t tool) const noexcept {
  const detail::Touch& touch = pressed(tool).touch(tool);
  if (touch.blade) return touch.blade->cut().tool().edge.normalized();
  return rotation_of(pressed(tool).view().to_world()) * touch.tool.axis();
}
PALPATE_INLINE Matrix3 TickView::proxy_rotation(std::size_t tool) const noexcept {
  const detail::Touch& touch = pressed(tool).touch(tool);
  if (touch.is_blade) return Matrix3::Identity();
  return rotation_of(pressed(tool).view().to_world()) * touch.tool.rotation;
}
PALPATE_INLINE Vector3 TickView::contact_force(std::size_t tool) const noexcept {
  Vector3 force = tissues_.front().force_on(tool);
  for (std::size_t k = 1; k < tissues_.size(); ++k) force += tissues_[k].force_on(tool);
  return force;
}
PALPATE_INLINE Vector3 TickView::contact_torque(std::size_t tool) const noexcept {
  Vector3 torque = tissues_.front().torque_on(tool);
  for (std::size_t k = 1; k < tissues_.size(); ++k) torque += tissues_[k].torque_on(tool);
  return torque;
}

}}  // namespace palpate
