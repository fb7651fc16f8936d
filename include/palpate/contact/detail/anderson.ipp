// Definitions of anderson.hpp.
#pragma once

#include <palpate/contact/detail/anderson.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE AndersonAcceleration::AndersonAcceleration(int capacity) : residual_(capacity) {
  const Step zero{VectorX::Zero(capacity), VectorX::Zero(capacity)};
  last_ = zero;
  difference_.fill(zero);
}

PALPATE_INLINE void AndersonAcceleration::extrapolate(int count, const double* x, double* g) noexcept {
  double square = 0.0;
  for (int i = 0; i < count; ++i) {
    residual_[i] = g[i] - x[i];
    square += residual_[i] * residual_[i];
  }
  if (has_last_ && square > growth * growth * square_) forget();
  square_ = square;
  Step& step = difference_[at(next_)];
  if (has_last_) {
    for (int i = 0; i < count; ++i) {
      step.residual[i] = residual_[i] - last_.residual[i];
      step.result[i] = g[i] - last_.result[i];
    }
    add_difference(count);
  }
  std::copy_n(residual_.data(), count, last_.residual.data());
  std::copy_n(g, count, last_.result.data());
  has_last_ = true;
  least_residual(count);
  double length = 0.0;
  for (int i = 0; i < count; ++i) {
    double by = 0.0;
    for (int k = 0; k < known_; ++k) by += weight_[at(k)] * difference_[at(k)].result[i];
    residual_[i] = by;
    length += by * by;
  }
  if (!(length > 0.0)) return;
  const double part = std::min(1.0, longest * std::sqrt(square / length));
  for (int i = 0; i < count; ++i) g[i] -= part * residual_[i];
}

/// Counts the difference just stored, and its products with the others.
PALPATE_INLINE void AndersonAcceleration::add_difference(int count) noexcept {
  const std::size_t own = at(next_);
  known_ = std::min(known_ + 1, depth);
  next_ = (next_ + 1) % depth;
  for (std::size_t k = 0; k < at(known_); ++k)
    products_[k][own] = products_[own][k] =
        difference_[k].residual.head(count).dot(difference_[own].residual.head(count));
}

/// Weights of the differences that leave the least residual: normal equations, by Cholesky. A difference that depends
/// on others gets none.
PALPATE_INLINE void AndersonAcceleration::least_residual(int count) noexcept {
  constexpr double dependent = 1e-10;
  std::array<std::array<double, depth>, depth> factor{};
  const std::size_t m = at(known_);
  for (std::size_t k = 0; k < m; ++k) {
    double value = difference_[k].residual.head(count).dot(residual_.head(count)), pivot = products_[k][k];
    for (std::size_t l = 0; l < k; ++l) {
      double entry = products_[k][l];
      for (std::size_t q = 0; q < l; ++q) entry -= factor[k][q] * factor[l][q];
      factor[k][l] = entry *= factor[l][l];
      pivot -= entry * entry;
      value -= entry * weight_[l];
    }
    factor[k][k] = pivot > dependent * products_[k][k] ? 1.0 / std::sqrt(pivot) : 0.0;
    weight_[k] = value * factor[k][k];
  }
  for (std::size_t k = m; k-- > 0;) {
    for (std::size_t l = k + 1; l < m; ++l) weight_[k] -= factor[l][k] * weight_[l];
    weight_[k] *= factor[k][k];
  }
}

}}  // namespace palpate
