// The free part of a matrix with changing values.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/SparseCore>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Lower half of K_ff on a pattern that is built once; new values are copied without allocation or search. 8 bytes per
/// entry in addition to the matrix.
class FreeValues {
 public:
  FreeValues() = default;
  FreeValues(const BlockMatrix& k, const EssentialConditions& conditions);

  const SparseMatrix& lower() const noexcept { return lower_; }

  /// Copies the values of a matrix on the same pattern with the same conditions.
  void update(const BlockMatrix& k, const EssentialConditions& conditions) noexcept;
  /// Adds to the diagonal, which is the first entry of each column of the lower half.
  void add_to_diagonal(double value) noexcept;
  /// Smallest value that, added to the diagonal, makes the matrix diagonally dominant, so positive semidefinite
  /// (Gershgorin 1931); 0 when it is already. NaN for a matrix that is not finite. `sums` is workspace, one number per
  /// row.
  double gershgorin_shift(VectorX& sums) const noexcept;

 private:
  SparseMatrix lower_;
  std::vector<Index> place_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/free_values.ipp>
#endif
