// The change of a compliance by one cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/cut_step.ipp>
#endif
