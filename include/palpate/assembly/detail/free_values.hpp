// The free part of a matrix whose values change.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/SparseCore>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Lower half of K_ff on a pattern made once; new values are copied without allocation or search. 8 bytes per entry
/// beside the matrix.
class FreeValues {
 public:
  FreeValues() = default;
  FreeValues(const BlockMatrix& k, const EssentialConditions& conditions);

  const SparseMatrix& lower() const noexcept { return lower_; }

  /// Takes the values of a matrix on the same pattern with the same conditions.
  void update(const BlockMatrix& k, const EssentialConditions& conditions) noexcept;
  /// The diagonal comes first in a column of the lower half.
  void add_to_diagonal(double value) noexcept;
  /// What must be added to the diagonal to make the matrix diagonally dominant, so positive semidefinite (Gershgorin
  /// 1931); 0 when it is. NaN for a matrix that is not finite. `sums` is room for a number per row.
  double gershgorin_shift(VectorX& sums) const noexcept;

 private:
  SparseMatrix lower_;
  std::vector<Index> place_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/free_values.ipp>
#endif
