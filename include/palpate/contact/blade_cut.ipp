// Definitions of blade_cut.hpp.
#pragma once

#include <palpate/contact/blade_cut.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE void BladeSlits::append(const Strip& made, double length, double largest_bend) noexcept {
  const int newest = (next_ + most - 1) % most;
  if (count_ > 0 && strip(newest).to == made.from && (made.from - strip(newest).from).norm() < length) {
    Strip grown = strip(newest);
    grown.to = made.to;
    if ((closest(grown, made.from) - made.from).norm() <= largest_bend) {
      grown.low = std::min(grown.low, made.low);
      grown.high = std::max(grown.high, made.high);
      strip(newest) = grown;
      return;
    }
  }
  strip(next_) = made;
  next_ = (next_ + 1) % most;
  count_ = std::min(count_ + 1, most);
}

PALPATE_INLINE void BladeSlits::add(const Vector3& from, const Vector3& to, double along, double length) noexcept {
  append({from, to, along, along}, length, length);
}

PALPATE_INLINE void BladeSlits::widen(const Vector3& from, const Slide& slide, double length) noexcept {
  append({from, slide.to, slide.low, slide.high}, length, touching);
}

PALPATE_INLINE Vector3 BladeSlits::closest(const Strip& strip, const Vector3& x) noexcept {
  const Vector3 line = strip.to - strip.from;
  const double square = line.squaredNorm();
  const double place = square > 0.0 ? (x - strip.from).dot(line) / square : 0.0;
  if (place >= 1.0) return strip.to;
  return place <= 0.0 ? strip.from : Vector3(strip.from + place * line);
}

PALPATE_INLINE double BladeSlits::fresh(const Strip& strip, double along, double length) noexcept {
  return std::min(1.0, std::max({0.0, strip.low - along, along - strip.high}) / length);
}

PALPATE_INLINE bool BladeSlits::find_nearest(const Vector3& x, double along, double length, double reach,
                                             Vector3& nearest) const noexcept {
  bool found = false;
  for (int i = 0; i < count_; ++i) {
    if (!(fresh(strip(i), along, length) < 1.0)) continue;
    const Vector3 point = closest(strip(i), x);
    const double distance = (point - x).norm();
    if (!(distance <= reach)) continue;
    reach = distance;
    nearest = point;
    found = true;
  }
  return found;
}

PALPATE_INLINE BladeSlits::Slide BladeSlits::find_slide(const Vector3& x, const Vector3& target, double along,
                                                        double length, double stretch) const noexcept {
  constexpr double least = 1e-12;  // [m]
  Slide best{-1, x};
  double nearest = (target - x).norm() - least;
  for (int i = 0; i < count_; ++i) {
    const Strip& s = strip(i);
    if ((closest(s, x) - x).norm() > touching) continue;
    const Vector3 line = s.to - s.from;
    const double size = line.norm();
    if (!(size > 0.0)) continue;
    const double part = fresh(s, along, length), pull = (target - x).dot(line) / size;
    const double move = std::max(0.0, std::abs(pull) - part * stretch);
    const Vector3 to = closest(s, x + std::copysign(move, pull) / size * line);
    const double distance = (target - to).norm();
    if (!(distance < nearest)) continue;
    nearest = distance;
    best = {i, to, part, std::min(s.low, along), std::max(s.high, along)};
  }
  return best;
}

}  // namespace detail

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
    const detail::BladeSlits::Slide s = slits_.find_slide(place_, target, along, length_, threshold / stiffness_);
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
