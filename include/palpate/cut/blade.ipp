// Definitions of blade.hpp.
#pragma once

#include <palpate/cut/blade.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE BladeCut::BladeCut(const BladeParameters& parameters) : parameters_(parameters) {
  const BladeParameters& p = parameters;
  for (const double value : {p.edge.norm(), p.forward.norm(), p.stiffness, p.stroke})
    if (!(value > 0.0 && value < infinity))
      raise(SetupErrorKind::bad_argument, "a parameter of the blade is " + number(value), "Give positive SI values");
  if (!(p.toughness >= 0.0 && p.toughness < infinity))
    raise(SetupErrorKind::bad_argument, "the toughness is " + number(p.toughness));
  parameters_.forward.normalize();
}

PALPATE_INLINE Vector3 BladeCut::advance(const Vector3& hand, double width) noexcept {
  if (!known_) {
    edge_ = hand;
    known_ = true;
    deepest_ = -infinity;
  }
  const Vector3& forward = parameters_.forward;
  const double pull = (hand - edge_).dot(forward), depth = edge_.dot(forward);
  const Vector3 along = hand - edge_ - pull * forward;
  if ((edge_ - line_ - (edge_ - line_).dot(forward) * forward).norm() > 0.5 * parameters_.edge.norm())
    deepest_ = -infinity;  // beside the slit
  edge_ += along;
  const double threshold = parameters_.toughness * width;
  if (pull <= 0.0 || threshold == 0.0) {
    edge_ = hand;
  } else {
    const double free = std::clamp(deepest_ - depth, 0.0, pull);
    const double hold = threshold / parameters_.stiffness, way = std::max(0.0, pull - free - hold);
    edge_ += (free + way) * forward;
    work_ += threshold * way;
    area_ += width * way;
  }
  if (width > 0.0 && edge_.dot(forward) > deepest_) {
    deepest_ = edge_.dot(forward);
    line_ = edge_;
  }
  return -parameters_.stiffness * (hand - edge_);
}

}}  // namespace palpate
