// Definitions of blade_cut.hpp.
#pragma once

#include <palpate/contact/detail/blade_cut.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE BladeCut::BladeCut(const BladeTool& tool, double stiffness) : tool_(tool), stiffness_(stiffness) {
  tool.require_valid();
  if (!(stiffness > 0.0 && stiffness < infinity))
    raise(SetupErrorKind::bad_argument, "the coupling stiffness of a blade is " + number(stiffness),
          "Give a finite one, in N/m: the edge stays in place while the coupling stretches");
  tool_.forward.normalize();
}

PALPATE_INLINE void BladeCut::reset() noexcept {
  edge_.setZero();
  line_.setZero();
  deepest_ = -infinity;
  area_ = work_ = 0.0;
  known_ = false;
}

PALPATE_INLINE Vector3 BladeCut::advance(const Vector3& hand, double width) noexcept {
  if (!known_) {
    edge_ = hand;
    known_ = true;
    deepest_ = -infinity;
  }
  const Vector3& forward = tool_.forward;
  const double pull = (hand - edge_).dot(forward), depth = edge_.dot(forward);
  const Vector3 along = hand - edge_ - pull * forward;
  if ((edge_ - line_ - (edge_ - line_).dot(forward) * forward).norm() > 0.5 * tool_.edge.norm())
    deepest_ = -infinity;  // outside the slit
  edge_ += along;
  const double threshold = tool_.toughness * width;
  if (pull <= 0.0 || threshold == 0.0) {
    edge_ = hand;
  } else {
    const double free = std::clamp(deepest_ - depth, 0.0, pull);
    const double stretch = threshold / stiffness_, path = std::max(0.0, pull - free - stretch);
    edge_ += (free + path) * forward;
    work_ += threshold * path;
    area_ += width * path;
  }
  if (width > 0.0 && edge_.dot(forward) > deepest_) {
    deepest_ = edge_.dot(forward);
    line_ = edge_;
  }
  return -stiffness_ * (hand - edge_);
}

}}  // namespace palpate
