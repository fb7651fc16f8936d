// Definitions of tick_view.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/tick_view.hpp>

namespace palpate { inline namespace PALPATE_ABI {

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
