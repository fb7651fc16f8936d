// Definitions of tick_view.hpp.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/blade_cut.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/detail/hand.hpp>
#include <palpate/haptic/tick_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE int TickView::contact_rows() const noexcept {
  return static_cast<int>(problem_.contacts().size());
}
PALPATE_INLINE double TickView::missing_depth() const noexcept {
  return problem_.missing_depth();
}
PALPATE_INLINE ForceError TickView::force_error(std::size_t tool) const noexcept {
  return hands_[tool].error;
}
PALPATE_INLINE double TickView::indentation(std::size_t tool) const noexcept {
  return problem_.indentation(tool, hands_[tool].tool);
}
PALPATE_INLINE bool TickView::is_holding(std::size_t tool) const noexcept {
  return problem_.is_holding(tool);
}
PALPATE_INLINE const BladeCut* TickView::blade(std::size_t tool) const noexcept {
  return hands_[tool].blade ? &hands_[tool].blade->cut() : nullptr;
}
PALPATE_INLINE const EnergyTank* TickView::energy(std::size_t tool) const noexcept {
  return hands_[tool].tank ? &*hands_[tool].tank : nullptr;
}
PALPATE_INLINE Vector3 TickView::proxy(std::size_t tool) const noexcept {
  const detail::Hand& hand = hands_[tool];
  return hand.blade ? hand.blade->cut().edge() : Vector3(tissue_.to_world() * hand.tool.proxy);
}
PALPATE_INLINE Vector3 TickView::proxy_axis(std::size_t tool) const noexcept {
  const detail::Hand& hand = hands_[tool];
  if (hand.blade) return hand.blade->cut().tool().edge.normalized();
  return rotation_of(tissue_.to_world()) * hand.tool.axis();
}
PALPATE_INLINE Matrix3 TickView::proxy_rotation(std::size_t tool) const noexcept {
  if (hands_[tool].blade) return Matrix3::Identity();
  return rotation_of(tissue_.to_world()) * hands_[tool].tool.rotation;
}
PALPATE_INLINE Vector3 TickView::contact_force(std::size_t tool) const noexcept {
  const detail::Hand& hand = hands_[tool];
  return hand.blade ? hand.blade->force() : Vector3(rotation_of(tissue_.to_world()) * hand.tool.force);
}
PALPATE_INLINE Vector3 TickView::contact_torque(std::size_t tool) const noexcept {
  return rotation_of(tissue_.to_world()) * hands_[tool].tool.torque;
}

}}  // namespace palpate
