// The stiffness restricted to the free dofs.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/assembly/detail/incomplete_cholesky.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// K restricted to the free dofs, as a preconditioned operator. Refers to its arguments, which must outlive it.
/// Satisfies SpdOperator; owns two workspaces, so it must not be used from two threads simultaneously. Copies share the
/// preconditioner.
class FreeStiffness {
 public:
  FreeStiffness() = default;
  /// Preconditioned by the inverse of the 3 x 3 diagonal blocks (block Jacobi).
  FreeStiffness(StiffnessView stiffness, const EssentialConditions& conditions);
  /// Preconditioned by an incomplete factorisation: several times fewer iterations. Throws as IncompleteCholesky does.
  FreeStiffness(const BlockMatrix& stiffness, const EssentialConditions& conditions, const SetupLimits& limits);

  Index size() const noexcept { return conditions_ != nullptr ? conditions_->free_count() : 0; }
  /// Of the preconditioner and the workspaces.
  std::size_t bytes() const noexcept;

  /// y = K_ff x. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept;
  /// y = P^-1 x. No allocation.
  void precondition(const VectorX& x, VectorX& y) const noexcept;

 private:
  std::optional<StiffnessView> stiffness_;
  const EssentialConditions* conditions_ = nullptr;
  std::shared_ptr<const std::vector<Matrix3>> inverse_blocks_;
  std::shared_ptr<const IncompleteCholesky> factor_;
  mutable VectorX in_, out_;
};

/// Calls visit(row, column, value) for every stored entry of the lower half of K_ff, rows ascending within a column.
template <class Visit>
void for_each_free_entry(const BlockMatrix& k, const EssentialConditions& conditions, Visit&& visit) {
  const BlockPattern& pattern = k.pattern();
  const std::vector<Index>& free = conditions.free_index;
  for (Index i = 0; i < pattern.rows(); ++i)
    for (Index p = pattern.row_start[static_cast<std::size_t>(i)];
         p < pattern.row_start[static_cast<std::size_t>(i) + 1]; ++p) {
      const Index j = pattern.column[static_cast<std::size_t>(p)];
      const auto block = k.block(p);
      for (int c = 0; c < 3; ++c) {
        const Index row = free[static_cast<std::size_t>(3 * i + c)];
        if (row < 0) continue;
        for (int d = 0; d < 3; ++d) {
          const Index column = free[static_cast<std::size_t>(3 * j + d)];
          if (column >= 0 && column <= row) visit(row, column, block.coeff(c, d));
        }
      }
    }
}

/// Lower half of the free part of a matrix (BlockMatrix, MassMatrix) as a compressed sparse matrix. O(entries),
/// allocates the result.
template <class Matrix>
SparseMatrix free_matrix(const Matrix& k, const EssentialConditions& conditions) {
  const Index n = conditions.free_count();
  SparseMatrix lower(n, n);
  Index* const start = lower.outerIndexPtr();
  std::fill_n(start, n + 1, Index{0});
  for_each_free_entry(k, conditions, [&](Index, Index column, double) { ++start[column + 1]; });
  std::partial_sum(start, start + n + 1, start);
  lower.resizeNonZeros(start[n]);
  std::vector<Index> next(start, start + n);
  for_each_free_entry(k, conditions, [&](Index row, Index column, double value) {
    const Index at = next[static_cast<std::size_t>(column)]++;
    lower.innerIndexPtr()[at] = row;
    lower.valuePtr()[at] = value;
  });
  return lower;
}

/// 1-norm of K_ff. O(entries).
double free_norm(const BlockMatrix& k, const EssentialConditions& conditions);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/detail/free_stiffness.ipp>
#endif
