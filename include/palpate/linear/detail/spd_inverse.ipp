// Definitions of spd_inverse.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/linear/detail/spd_inverse.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void SpdInverse::invert(MatrixX& matrix, double threshold, const char* what,
                                       const SetupThreads& threads) {
  SpdInverse inverse(matrix, threshold, threads);
  const Index n = matrix.rows();
  inverse.split(0, n);
  bool good = inverse.worst_ > threshold;
  for (Index j = 0; j < n; ++j) good = good && std::isfinite(*inverse.at(j, j));
  if (!good) {
    SetupProblem p;
    p.kind = SetupErrorKind::not_positive_definite;
    p.what = what;
    p.value = inverse.worst_;
    p.threshold = threshold;
    raise(std::move(p));
  }
  constexpr Index block = 32;  // rows and columns that stay in the cache
  for (Index first = 0; first < n; first += block)
    for (Index j = 0; j < n; ++j)
      for (Index i = std::max(first, j + 1); i < std::min(first + block, n); ++i) *inverse.at(j, i) = *inverse.at(i, j);
}

PALPATE_INLINE SpdInverse::SpdInverse(MatrixX& matrix, double threshold, const SetupThreads& threads)
    : a_(matrix.data()), n_(matrix.rows()), diagonal_(matrix.rows()), threshold_(threshold), threads_(threads) {
  for (Index j = 0; j < n_; ++j) diagonal_.data()[j] = *at(j, j);
}

PALPATE_INLINE void SpdInverse::split(Index begin, Index size) {
  using detail::Read;
  if (!(worst_ > threshold_)) return;
  if (size <= leaf) return invert_leaf(begin, size);
  const Index m = (size / 2 + 31) / 32 * 32, rest = size - m;
  double* const a11 = at(begin, begin);
  double* const a21 = at(begin + m, begin);
  double* const a22 = at(begin + m, begin + m);
  split(begin, m);
  std::vector<double> t(static_cast<std::size_t>(rest * m), 0.0);
  add_product({t.data(), rest, m, rest}, 1.0, {a21, n_}, {a11, n_, Read::symmetric}, m, threads_);
  add_product({a22, rest, rest, n_, true}, -1.0, {t.data(), rest}, {a21, n_, Read::transposed}, m, threads_);
  split(begin + m, rest);
  for (Index j = 0; j < m; ++j) std::fill_n(a21 + j * n_, rest, 0.0);
  add_product({a21, rest, m, n_}, -1.0, {a22, n_, Read::symmetric}, {t.data(), rest}, rest, threads_);
  add_product({a11, m, m, n_, true}, -1.0, {t.data(), rest, Read::transposed}, {a21, n_}, rest, threads_);
}

/// Cholesky in a copy, column by column, then the inverse of its factor L, then L^-T L^-1.
PALPATE_INLINE void SpdInverse::invert_leaf(Index begin, Index size) {
  std::vector<double> factor(leaf * leaf), inverse(leaf * leaf, 0.0);
  const auto l = [&](Index j) { return factor.data() + j * leaf; };
  const auto column = [&](Index j) { return inverse.data() + j * leaf; };
  for (Index j = 0; j < size; ++j)
    for (Index i = j; i < size; ++i) l(j)[i] = *at(begin + i, begin + j);
  for (Index j = 0; j < size; ++j) {
    for (Index q = 0; q < j; ++q) add_scaled(l(j) + j, -l(q)[j], l(q) + j, size - j);
    const double pivot = l(j)[j], ratio = pivot / diagonal_.data()[begin + j];
    if (!(std::isfinite(ratio) && ratio >= worst_)) worst_ = ratio;
    if (!(worst_ > threshold_)) return;
    const double root = std::sqrt(pivot);
    for (Index i = j; i < size; ++i) l(j)[i] /= root;
  }
  for (Index j = 0; j < size; ++j) {
    column(j)[j] = 1.0;
    for (Index q = j; q < size; ++q) {
      column(j)[q] /= l(q)[q];
      add_scaled(column(j) + q + 1, -column(j)[q], l(q) + q + 1, size - q - 1);
    }
  }
  for (Index j = 0; j < size; ++j)
    for (Index i = j; i < size; ++i) *at(begin + i, begin + j) = dot(column(i) + i, column(j) + i, size - i);
}

}}}  // namespace palpate::detail
