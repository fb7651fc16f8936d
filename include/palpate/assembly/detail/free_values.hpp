// The free part of a matrix with changing values.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
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

inline FreeValues::FreeValues(const BlockMatrix& k, const EssentialConditions& conditions)
    : lower_(free_matrix(k, conditions)) {
  place_.reserve(static_cast<std::size_t>(lower_.nonZeros()));
  std::vector<Index> next(lower_.outerIndexPtr(), lower_.outerIndexPtr() + lower_.cols());
  for_each_free_entry(k, conditions,
                      [&](Index, Index column, double) { place_.push_back(next[static_cast<std::size_t>(column)]++); });
}

inline void FreeValues::update(const BlockMatrix& k, const EssentialConditions& conditions) noexcept {
  auto place = place_.begin();
  double* const values = lower_.valuePtr();
  for_each_free_entry(k, conditions, [&](Index, Index, double value) { values[*place++] = value; });
}

inline void FreeValues::add_to_diagonal(double value) noexcept {
  for (Index j = 0; j < lower_.cols(); ++j) lower_.valuePtr()[lower_.outerIndexPtr()[j]] += value;
}

inline double FreeValues::gershgorin_shift(VectorX& sums) const noexcept {
  sums.setZero();
  for (Index j = 0; j < lower_.cols(); ++j) {
    const Index first = lower_.outerIndexPtr()[j];
    sums[j] -= lower_.valuePtr()[first];
    for (Index p = first + 1; p < lower_.outerIndexPtr()[j + 1]; ++p) {
      const double size = std::abs(lower_.valuePtr()[p]);
      sums[j] += size;
      sums[lower_.innerIndexPtr()[p]] += size;
    }
  }
  return sums.allFinite() ? std::max(0.0, sums.maxCoeff()) : std::numeric_limits<double>::quiet_NaN();
}

}}  // namespace palpate
