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
  length_ = tool.edge.norm();
  direction_ = tool.edge / length_;
}

PALPATE_INLINE void BladeCut::reset() noexcept {
  for (Vector3* x : {&edge_, &cut_from_, &hand_, &place_}) x->setZero();
  slits_.clear();
  slack_ = area_ = work_ = 0.0;
  known_ = inside_ = false;
}

/// Begins in the tissue: in a slit if there is one nearby.
PALPATE_INLINE void BladeCut::enter(double along) noexcept {
  const Vector3 across = edge_ - edge_.dot(direction_) * direction_;
  place_ = across;
  slits_.find_nearest(across, along, length_, tool_.cut_spacing, place_);
  slack_ = (across - place_).norm();
  inside_ = true;
}

/// Slides through slits towards the target; whether it did without resistance.
PALPATE_INLINE bool BladeCut::slide(const Vector3& target, double along, double width) noexcept {
  const double threshold = tool_.toughness * width;
  bool freely = false;
  for (int k = 0; k < most_slides; ++k) {
    const BladeSlits::Slide s = slits_.find_slide(place_, target, along, length_, threshold / stiffness_);
    if (s.strip < 0) break;
    const double path = (s.to - place_).norm();
    work_ += s.fresh * threshold * path;
    area_ += s.fresh * width * path;
    freely = freely || s.fresh == 0.0;
    if (s.fresh > 0.0) slits_.widen(place_, s, tool_.cut_spacing);
    place_ = s.to;
  }
  return freely;
}

PALPATE_INLINE Vector3 BladeCut::advance(const Vector3& hand, double width) noexcept {
  if (!known_) {
    edge_ = hand_ = hand;
    known_ = true;
    inside_ = false;
  }
  const Vector3 last = hand_;
  cut_from_ = edge_;
  hand_ = hand;
  if (!(width > 0.0)) {
    if ((edge_ - last).norm() > 0.0) cut_from_ = last;  // the coupling was stretched
    edge_ = hand;
    inside_ = false;
    return Vector3::Zero();
  }
  const double along = hand.dot(direction_);
  const Vector3 target = hand - along * direction_;
  if (!inside_) enter(along);
  const bool slid = slide(target, along, width) || slack_ > 0.0;
  const Vector3 pull = target - place_;
  const double distance = pull.norm(), elastic = std::min(slack_, distance);
  const Vector3 ahead = distance > 0.0 ? Vector3(pull / distance) : Vector3(Vector3::Zero());
  const double path = std::max(0.0, distance - elastic - tool_.toughness * width / stiffness_);
  Vector3 across = place_ + elastic * ahead;
  if (slid) cut_from_ = across + along * direction_;
  if (path > 0.0) {
    across += path * ahead;
    work_ += tool_.toughness * width * path;
    area_ += width * path;
    slits_.add(place_, across, along, tool_.cut_spacing);
    place_ = across;
    slack_ = 0.0;
  }
  edge_ = across + along * direction_;
  return -stiffness_ * (hand - edge_);
}

}}  // namespace palpate
