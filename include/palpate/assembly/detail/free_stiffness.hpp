// The stiffness restricted to the free dofs.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// A block of K with the identity in place of the prescribed dofs of both nodes.
inline Matrix3 free_block(const double* k, unsigned fixed_rows, unsigned fixed_columns, bool diagonal) noexcept {
  Matrix3 block;
  for (int d = 0; d < 3; ++d)
    for (int c = 0; c < 3; ++c) {
      const bool fixed = ((fixed_rows >> c) & 1u) != 0 || ((fixed_columns >> d) & 1u) != 0;
      block.data()[3 * d + c] = !fixed ? k[3 * d + c] : diagonal && c == d ? 1.0 : 0.0;
    }
  return block;
}

}  // namespace detail

/// P = L D L^T on the pattern of K, without fill (IC(0) of Meijerink and van der Vorst 1977, by blocks). When a pivot
/// block is not safely positive definite, the factorisation restarts with a larger multiple of the diagonal blocks of K
/// added to K (Manteuffel 1980): P is positive definite. L is stored in single precision, half the memory of K.
/// Prescribed dofs are replaced by the identity.
class IncompleteCholesky {
 public:
  IncompleteCholesky() = default;
  /// O(blocks x blocks per row). Throws too_large and cancelled, and not_positive_definite when no multiple helps:
  /// then K is not finite, or far from positive definite.
  IncompleteCholesky(const BlockMatrix& k, const EssentialConditions& conditions, const SetupLimits& limits);

  std::size_t bytes() const noexcept;
  /// The multiple of the diagonal blocks that was added.
  double shift() const noexcept { return shift_; }
  /// z = P^-1 r over the dofs of all nodes. Reads every block twice; no allocation.
  void solve_into(const VectorX& r, VectorX& z) const noexcept;

 private:
  using Block = std::array<float, 9>;  // column-major

  void copy_pattern(const BlockMatrix& k, const SetupLimits& limits);
  /// The first row whose pivot fails; -1 for none.
  Index factorise(const BlockMatrix& k, const EssentialConditions& conditions, const SetupLimits& limits);
  bool factorise_row(const BlockMatrix& k, const EssentialConditions& conditions, Index row,
                     std::vector<Matrix3>& scaled);

  static constexpr double smallest_pivot = 1e-10;  // of the diagonal of K
  static constexpr double largest_shift = 100.0;

  std::vector<Index> row_start_;  // rows + 1 offsets of the blocks left of the diagonal
  std::vector<NodeId> column_;    // ascending in a row
  std::vector<Block> lower_;
  std::vector<Matrix3> inverse_pivot_;
  double shift_ = 0.0;
};

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
