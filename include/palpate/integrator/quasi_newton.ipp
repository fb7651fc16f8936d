// Definitions of quasi_newton.hpp.
#pragma once

#include <palpate/integrator/quasi_newton.hpp>
#include <palpate/core/setup_error.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE QuasiNewtonMethod::QuasiNewtonMethod(Index size, int memory)
    : memory_(memory),
      residual_(size),
      direction_(size),
      trial_(size),
      trial_residual_(size),
      work_(size),
      product_(size),
      other_product_(size) {
  if (memory < 1 || memory > 100)
    raise(SetupErrorKind::bad_argument, "a memory of " + std::to_string(memory) + " pairs", "Give 1 to 100");
  steps_.setZero(size, memory);
  changes_.setZero(size, memory);
  curvature_.setZero(memory);
  weight_.setZero(memory);
}

PALPATE_INLINE void QuasiNewtonMethod::remember(const VectorX& from, const VectorX& to, const VectorX& residual_there,
                                                double least) noexcept {
  auto step = steps_.col(next_), change = changes_.col(next_);
  step = to - from;
  change = residual_ - residual_there;
  const double product = step.dot(change);
  if (!(product > least) || !(product > 1e-8 * step.norm() * change.norm())) return;
  curvature_[next_] = 1.0 / product;
  next_ = (next_ + 1) % memory_;
  count_ = std::min(count_ + 1, memory_);
}

}}  // namespace palpate
