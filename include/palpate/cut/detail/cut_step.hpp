// What one cut does to a compliance.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// What one cut does to the compliance among kept dofs: C_ij - z_i . y_j for those that were, and columns of their own
/// for those that came. Immutable; a tick reads it next to the compliance before the cut.
struct CutStep {
  std::shared_ptr<const MatrixX> compliance;  ///< before the cut; the first `old` rows and columns count [m/N]
  MatrixX z, y;                               ///< changed dofs x old
  MatrixX extra;                              ///< all x (all - old), exact
  Index old = 0, all = 0;                     ///< kept dofs before and after
  double smallest = 1.0;                      ///< BorderedUpdate::smallest

  /// Displacement of kept dof i per force on j [m/N].
  double operator()(Index i, Index j) const noexcept;
  /// sum_i += C_ij^2 for all i.
  void add_squares(Index j, VectorX& sum) const noexcept;
  Index rank() const noexcept { return z.rows(); }
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/cut_step.ipp>
#endif
