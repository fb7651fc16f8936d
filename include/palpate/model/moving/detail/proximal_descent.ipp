// Definitions of proximal_descent.hpp.
#pragma once

#include <palpate/model/moving/detail/proximal_descent.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ProximalDescent::ProximalDescent(TangentSolver& tangent, Index size)
    : tangent_(tangent), residual_(size), step_(size), centre_(size), mode_(size) {
  forget();
}

PALPATE_INLINE void ProximalDescent::forget() noexcept {
  for (Index i = 0; i < mode_.size(); ++i) mode_[i] = std::sin(1.0 + static_cast<double>(i));
}

PALPATE_INLINE bool ProximalDescent::find_shift(double& shift, int& count) noexcept {
  constexpr int most_attempts = 12;
  ++count;
  if (!tangent_.factorise()) return false;
  shift = tangent_.shift() > 0.0 ? tangent_.shift() : 1e-3 * tangent_.largest_diagonal();
  double too_small = 0.0;
  for (int k = 0; k < most_attempts; ++k) {
    // a large shift hides the soft modes: it decreases step by step, and the mode becomes accurate with it
    const double curvature = soften();
    double next = curvature < 0.0 ? -2.0 * curvature : shift / 16.0;
    if (next <= too_small) next = std::sqrt(too_small * shift);
    if (!(next < 0.5 * shift)) break;
    ++count;
    if (tangent_.factorise_shifted(next)) {
      shift = next;
    } else {
      too_small = next;
      if (!tangent_.factorise_shifted(shift)) return false;
      ++count;
      if (shift <= 4.0 * too_small) break;
    }
  }
  soften();
  mode_.normalize();
  return true;
}

PALPATE_INLINE double ProximalDescent::soften() noexcept {
  double curvature = 0.0;
  for (int k = 0; k < 6; ++k) {
    mode_.normalize();
    tangent_.solve(mode_, step_);
    curvature = 1.0 / mode_.dot(step_) - tangent_.shift();
    mode_.swap(step_);
  }
  return curvature;
}

}}  // namespace palpate
