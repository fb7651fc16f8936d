// Definitions of servo_blade.hpp.
#pragma once

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/detail/servo_blade.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void ServoBlade::follow(const Vector3& hand, bool restart, const TissueView& tissue) noexcept {
  status_ = {};
  if (restart) cut_.lift();
  force_ = cut_.advance(hand, restart ? 0.0 : width_inside(tissue));
  if (restart) ordered_ = cut_.edge();
  if (!order_cut(tissue)) status_.set(StatusFlag::degraded_model);
}

PALPATE_INLINE void ServoBlade::lift() noexcept {
  cut_.lift();
  force_.setZero();
  status_ = {};
}

PALPATE_INLINE void ServoBlade::reset() noexcept {
  cut_.reset();
  force_.setZero();
  ordered_.setZero();
  status_ = {};
}

PALPATE_INLINE double ServoBlade::width_inside(const TissueView& tissue) const noexcept {
  const Vector3& edge = cut_.tool().edge;
  const Eigen::Isometry3d to_model = inverse(tissue.to_world());
  int inside = 0;
  for (int k = 0; k < samples; ++k) {
    const Vector3 x = cut_.edge() + ((k + 0.5) / samples - 0.5) * edge;
    if (tissue.contact_surface().is_inside(to_model * x)) ++inside;
  }
  return edge.norm() * inside / samples;
}

/// Requests a cut along the surface swept since the last request; false when the tissue cannot accept it yet.
PALPATE_INLINE bool ServoBlade::order_cut(const TissueView& tissue) noexcept {
  const BladeTool& tool = cut_.tool();
  const Vector3 path = cut_.edge() - ordered_;
  if (path.dot(tool.forward) < 0.0) ordered_ = cut_.edge();  // back through the slit
  if (path.norm() < tool.cut_spacing) return true;
  const Vector3 half = 0.5 * tool.edge;
  if (!tissue.try_cut({ordered_ - half, ordered_ + half, cut_.edge() - half, cut_.edge() + half})) return false;
  ordered_ = cut_.edge();
  return true;
}

}}  // namespace palpate
