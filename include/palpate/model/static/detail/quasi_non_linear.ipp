// Definitions of quasi_non_linear.hpp.
#pragma once

#include <palpate/model/static/detail/quasi_non_linear.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE StiffeningCurve::StiffeningCurve(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.empty() || points_.front().displacement != 0.0)
    refuse("does not start at a displacement of 0", points_.empty() ? 0.0 : points_.front().displacement);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    if (!(p.ratio > 0.0 && p.ratio < infinity)) refuse("has the ratio " + number(p.ratio), p.displacement);
    if (i == 0) continue;
    const Point& before = points_[i - 1];
    if (!(p.displacement > before.displacement && p.displacement < infinity))
      refuse("has displacements that do not rise", p.displacement);
    // d(force) / d(displacement) is linear between two points: positive everywhere if positive at both
    const double slope = (p.ratio - before.ratio) / (p.displacement - before.displacement);
    for (const Point& end : {before, p})
      if (!(end.ratio + slope * end.displacement > 0.0)) refuse("has a force that falls", end.displacement);
  }
}

PALPATE_INLINE double StiffeningCurve::ratio(double displacement) const noexcept {
  if (!(displacement > 0.0)) return points_.front().ratio;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point &a = points_[i - 1], &b = points_[i];
    if (displacement < b.displacement)
      return a.ratio + (displacement - a.displacement) / (b.displacement - a.displacement) * (b.ratio - a.ratio);
  }
  return points_.back().ratio;
}

PALPATE_INLINE void StiffeningCurve::refuse(const std::string& what, double value) {
  SetupProblem p;
  p.kind = SetupErrorKind::bad_argument;
  p.what = "a stiffening curve " + what + ", at " + number(value) + " m";
  p.hint = "Give points from 0 on with a force that rises";
  p.value = value;
  raise(std::move(p));
}

}}  // namespace palpate
