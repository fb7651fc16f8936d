// Definitions of cut_step.hpp.
#pragma once

#include <palpate/cut/detail/cut_step.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double CutStep::operator()(Index i, Index j) const noexcept {
  if (j >= old) return extra(i, j - old);
  if (i >= old) return extra(j, i - old);
  double value = (*compliance)(i, j);
  const Index rank = z.rows();
  const double *a = z.data() + i * rank, *b = y.data() + j * rank;
  for (Index k = 0; k < rank; ++k) value -= a[k] * b[k];
  return value;
}

PALPATE_INLINE void CutStep::add_squares(Index j, VectorX& sum) const noexcept {
  if (j >= old) {
    sum.array() += extra.col(j - old).array().square();
  } else if (rank() == 0) {
    sum.head(old).array() += compliance->col(j).head(old).array().square();
    if (all > old) sum.tail(all - old).array() += extra.row(j).transpose().array().square();
  } else {
    for (Index i = 0; i < all; ++i) sum[i] += (*this)(i, j) * (*this)(i, j);
  }
}

}}  // namespace palpate
