// Definitions of local_indentation.hpp.
#pragma once

#include <palpate/contact/detail/local_indentation.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE LocalIndentation::LocalIndentation(double radius, const FacetScale& facets, double known) noexcept
    : radius_(radius),
      unit_(4.0 / 3.0 * facets.material.modulus * radius * radius),
      steeper_(1.7 * facets.material.poisson_ratio * facets.material.poisson_ratio) {
  constexpr double shown = 0.7;
  if (!(facets.material.modulus > 0.0 && facets.length > 0.0)) return;
  shown_ = shown / (facets.material.modulus * facets.length);
  const double t = std::clamp((coarse - radius / facets.length) / (coarse - fine), 0.0, 1.0);
  share_ = known * t * t * (3.0 - 2.0 * t);
}

PALPATE_INLINE LocalIndentation::Law LocalIndentation::law(double depth) const noexcept {
  const double d = std::min(depth, 1.0), root = std::sqrt(d);
  const Law inside{d * root - steeper_ * d * d * d, 1.5 * root - 3.0 * steeper_ * d * d};
  return {inside.force + (depth - d) * inside.slope, inside.slope};
}

/// Newton's method from Hertz's depth, which is less than the solution; the slope has bounds there.
PALPATE_INLINE double LocalIndentation::half_space(double force) const noexcept {
  if (!(force > 0.0)) return 0.0;
  const double wanted = force / unit_;
  double d = std::cbrt(wanted * wanted);
  for (int i = 0; i < 20; ++i) {
    const auto [got, slope] = law(d);
    const double step = (wanted - got) / slope;
    d += step;
    if (!(std::abs(step) > 1e-14 * d)) break;
  }
  return radius_ * d;
}

PALPATE_INLINE double LocalIndentation::secant(double force) const noexcept {
  if (share_ == 0.0) return 0.0;
  const double f = std::max(force, smallest_force());
  return depth(f) / f;
}

/// Newton's method within bounds, in the indentation of the half-space.
PALPATE_INLINE double LocalIndentation::force_of(double rest, double total) const noexcept {
  if (share_ == 0.0) return rest > 0.0 ? total / rest : 0.0;
  const double own = share_ * radius_, other = std::max(0.0, rest - share_ * shown_) * unit_;
  double low = 0.0, high = total / own, d = high;
  for (int i = 0; i < 60 && high > low; ++i) {
    const auto [force, slope] = law(d);
    const double beyond = own * d + other * force - total;
    (beyond > 0.0 ? high : low) = d;
    const double step = beyond / (own + other * slope);
    if (!(std::abs(step) > 1e-12 * d)) break;
    const double next = d - step;
    d = next > low && next < high ? next : 0.5 * (low + high);
  }
  return unit_ * law(d).force;
}

}}  // namespace palpate
