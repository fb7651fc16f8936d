// The stiffness restricted to the free dofs.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/detail/incomplete_cholesky.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

namespace detail {

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
  std::size_t bytes() const noexcept {
    return (inverse_blocks_ ? inverse_blocks_->size() * sizeof(Matrix3) : 0) + (factor_ ? factor_->bytes() : 0) +
           static_cast<std::size_t>(in_.size() + out_.size()) * sizeof(double);
  }

  /// y = K_ff x. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept {
    conditions_->scatter(x, in_);
    stiffness_->apply(in_, out_);
    conditions_->gather(out_, y);
  }
  /// y = P^-1 x. No allocation.
  void precondition(const VectorX& x, VectorX& y) const noexcept;

 private:
  std::optional<StiffnessView> stiffness_;
  const EssentialConditions* conditions_ = nullptr;
  std::shared_ptr<const std::vector<Matrix3>> inverse_blocks_;
  std::shared_ptr<const IncompleteCholesky> factor_;
  mutable VectorX in_, out_;
};

}  // namespace detail

/// Calls visit(row, column, value) for every stored entry of the lower half of K_ff, rows ascending within a column.
template <class Visit>
void for_each_free_entry(const BlockMatrix& k, const EssentialConditions& conditions, Visit&& visit) {
  const detail::BlockPattern& pattern = k.pattern();
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

namespace detail {

inline FreeStiffness::FreeStiffness(StiffnessView stiffness, const EssentialConditions& conditions)
    : stiffness_(stiffness), conditions_(&conditions), in_(stiffness.size()), out_(stiffness.size()) {
  std::vector<Matrix3> blocks = stiffness.diagonal_blocks();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const unsigned fixed = conditions.constrained[i];
    blocks[i] = inverse(free_block(blocks[i].data(), fixed, fixed, true));
  }
  inverse_blocks_ = std::make_shared<const std::vector<Matrix3>>(std::move(blocks));
}

inline FreeStiffness::FreeStiffness(const BlockMatrix& stiffness, const EssentialConditions& conditions,
                                    const SetupLimits& limits)
    : stiffness_(stiffness),
      conditions_(&conditions),
      factor_(std::make_shared<const IncompleteCholesky>(stiffness, conditions, limits)),
      in_(stiffness.size()),
      out_(stiffness.size()) {}

inline void FreeStiffness::precondition(const VectorX& x, VectorX& y) const noexcept {
  conditions_->scatter(x, in_);
  if (factor_)
    factor_->solve_into(in_, out_);
  else
    for (std::size_t i = 0; i < inverse_blocks_->size(); ++i) {
      const auto node = static_cast<Index>(i);
      set_node_vector(out_, node, (*inverse_blocks_)[i] * node_vector(in_, node));
    }
  conditions_->gather(out_, y);
}

/// 1-norm of K_ff. O(entries).
inline double free_norm(const BlockMatrix& k, const EssentialConditions& conditions) {
  VectorX sums = VectorX::Zero(conditions.free_count());
  for_each_free_entry(k, conditions, [&](Index row, Index column, double value) {
    sums[column] += std::abs(value);
    if (row != column) sums[row] += std::abs(value);
  });
  return sums.size() > 0 ? sums.maxCoeff() : 0.0;
}

}  // namespace detail

}}  // namespace palpate
