// Definitions of blade_slits.hpp.
#pragma once

#include <palpate/contact/detail/blade_slits.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate
