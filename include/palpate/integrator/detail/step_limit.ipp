// Definitions of step_limit.hpp.
#pragma once

#include <palpate/integrator/detail/step_limit.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE StepLimit::StepLimit(Index dofs, double bound, double margin)
    : vector_(dofs), moved_(dofs), force_(dofs), bound_(bound), margin_(margin) {
  restart();
}

PALPATE_INLINE void StepLimit::restart() noexcept {
  for (Index i = 0; i < vector_.size(); ++i) vector_[i] = start_value(static_cast<std::uint64_t>(i));
  square_ = 0.0;
  iterations_ = 0;
}

PALPATE_INLINE double StepLimit::largest_square() const noexcept {
  return iterations_ < settled && square_ < bound_ ? bound_ : square_;  // NaN is preserved
}

PALPATE_INLINE double StepLimit::step() const noexcept {
  const double square = largest_square();
  return std::isfinite(square) ? (1.0 - margin_) * 2.0 / std::sqrt(square) : 0.0;
}

PALPATE_INLINE double StepLimit::start_value(std::uint64_t i) noexcept {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
}

}}  // namespace palpate
