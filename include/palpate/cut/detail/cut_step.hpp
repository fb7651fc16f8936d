// The change of a compliance by one cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Compliance among kept dofs after one cut: C_ij - z_i . y_j for dofs that were kept before, and explicit columns for
/// added dofs. Immutable; a tick reads it together with the compliance before the cut.
struct CutStep {
  std::shared_ptr<const MatrixX> compliance;  ///< before the cut; only the first `old` rows and columns are used [m/N]
  MatrixX z, y;                               ///< changed dofs x old
  MatrixX extra;                              ///< all x (all - old), exact
  Index old = 0, all = 0;                     ///< kept dofs before and after
  double smallest = 1.0;                      ///< BorderedUpdate::smallest

  /// Displacement of kept dof i per force on kept dof j [m/N].
  double operator()(Index i, Index j) const noexcept;
  /// sum_i += C_ij^2 for all i.
  void add_squares(Index j, VectorX& sum) const noexcept;
  Index rank() const noexcept { return z.rows(); }
};

inline double CutStep::operator()(Index i, Index j) const noexcept {
  if (j >= old) return extra(i, j - old);
  if (i >= old) return extra(j, i - old);
  double value = (*compliance)(i, j);
  const Index rank = z.rows();
  const double *a = z.data() + i * rank, *b = y.data() + j * rank;
  for (Index k = 0; k < rank; ++k) value -= a[k] * b[k];
  return value;
}

inline void CutStep::add_squares(Index j, VectorX& sum) const noexcept {
  if (j >= old) {
    sum.array() += extra.col(j - old).array().square();
  } else if (rank() == 0) {
    sum.head(old).array() += compliance->col(j).head(old).array().square();
    if (all > old) sum.tail(all - old).array() += extra.row(j).transpose().array().square();
  } else {
    for (Index i = 0; i < all; ++i) sum[i] += (*this)(i, j) * (*this)(i, j);
  }
}

}}}  // namespace palpate::detail
