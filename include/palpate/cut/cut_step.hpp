// What one cut does to a compliance.
#pragma once

#include <palpate/core/types.hpp>

#include <memory>

namespace palpate::inline PALPATE_ABI {

/// What one cut does to the compliance among kept dofs: C_ij - z_i . y_j for those that were, and columns of their own
/// for those that came. Immutable; a tick reads it next to the compliance before the cut.
struct CutStep {
  std::shared_ptr<const MatrixX> compliance;  ///< before the cut, `old` x `old` [m/N]
  MatrixX z, y;                               ///< changed dofs x old
  MatrixX extra;                              ///< all x (all - old), exact
  Index old = 0, all = 0;                     ///< kept dofs before and after
  double smallest = 1.0;                      ///< BorderedUpdate::smallest

  /// Displacement of kept dof i per force on j [m/N].
  double operator()(Index i, Index j) const noexcept {
    if (j >= old) return extra(i, j - old);
    if (i >= old) return extra(j, i - old);
    double value = (*compliance)(i, j);
    const Index rank = z.rows();
    const double *a = z.data() + i * rank, *b = y.data() + j * rank;
    for (Index k = 0; k < rank; ++k) value -= a[k] * b[k];
    return value;
  }
  Index rank() const noexcept { return z.rows(); }
};

}  // namespace palpate::inline PALPATE_ABI
