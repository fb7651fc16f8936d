// The stiffness seen by the free dofs.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/concepts/assembler.hpp>
#include <palpate/concepts/linear_solver.hpp>

#include <Eigen/LU>
#include <Eigen/SparseCore>

namespace palpate::inline PALPATE_ABI {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

/// K restricted to the free dofs, as an operator with a block Jacobi preconditioner. Refers to `stiffness` and
/// `conditions`, which must outlive it. Satisfies SpdOperator; owns two workspaces, so it is not to be used from two
/// threads at once.
template <StiffnessOperator Stiffness>
class FreeStiffness {
 public:
  FreeStiffness() = default;
  FreeStiffness(const Stiffness& stiffness, const EssentialConditions& conditions)
      : stiffness_(&stiffness),
        conditions_(&conditions),
        inverse_blocks_(stiffness.diagonal_blocks()),
        in_(stiffness.size()),
        out_(stiffness.size()) {
    for (std::size_t i = 0; i < inverse_blocks_.size(); ++i) {
      Matrix3& block = inverse_blocks_[i];
      for (int c = 0; c < 3; ++c)
        if ((conditions.constrained[i] & (1u << c)) != 0) {
          block.row(c).setZero();
          block.col(c).setZero();
          block(c, c) = 1.0;
        }
      block = block.inverse().eval();
    }
  }

  Index size() const noexcept { return conditions_ != nullptr ? conditions_->free_count() : 0; }
  const Stiffness& stiffness() const noexcept { return *stiffness_; }
  const EssentialConditions& conditions() const noexcept { return *conditions_; }

  /// y = K_ff x. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept {
    conditions_->scatter(x, in_);
    stiffness_->apply(in_, out_);
    conditions_->gather(out_, y);
  }
  /// y = P^-1 x with P the 3 x 3 diagonal blocks. No allocation.
  void precondition(const VectorX& x, VectorX& y) const noexcept {
    conditions_->scatter(x, in_);
    for (std::size_t i = 0; i < inverse_blocks_.size(); ++i)
      out_.segment<3>(3 * static_cast<Index>(i)).noalias() =
          inverse_blocks_[i] * in_.segment<3>(3 * static_cast<Index>(i));
    conditions_->gather(out_, y);
  }

 private:
  const Stiffness* stiffness_ = nullptr;
  const EssentialConditions* conditions_ = nullptr;
  std::vector<Matrix3> inverse_blocks_;
  mutable VectorX in_, out_;
};

/// Lower half of K_ff as a sparse matrix. The block pattern is stored by rows of the lower half, which read as columns
/// of the upper one.
inline SparseMatrix free_matrix(const BlockMatrix& k, const EssentialConditions& conditions) {
  const BlockPattern& pattern = k.pattern();
  const Index n = conditions.free_count();
  SparseMatrix upper(n, n);  // built column by column; each column ends at its diagonal
  Eigen::Matrix<Index, Eigen::Dynamic, 1> counts = Eigen::Matrix<Index, Eigen::Dynamic, 1>::Zero(n);
  const auto visit = [&](auto&& entry) {
    for (Index i = 0; i < pattern.rows(); ++i)
      for (int c = 0; c < 3; ++c) {
        const Index col = conditions.free_index[static_cast<std::size_t>(3 * i + c)];
        if (col < 0) continue;
        for (Index p = pattern.row_start[static_cast<std::size_t>(i)];
             p < pattern.row_start[static_cast<std::size_t>(i) + 1]; ++p)
          for (int d = 0; d < 3; ++d) {
            const Index row =
                conditions
                    .free_index[static_cast<std::size_t>(3 * Index{pattern.column[static_cast<std::size_t>(p)]} + d)];
            if (row >= 0 && row <= col) entry(row, col, p, c, d);
          }
      }
  };
  visit([&](Index, Index col, Index, int, int) { ++counts[col]; });
  upper.reserve(counts);
  visit([&](Index row, Index col, Index p, int c, int d) { upper.insert(row, col) = k.block(p)(c, d); });
  upper.makeCompressed();
  return SparseMatrix(upper.transpose());
}

}  // namespace palpate::inline PALPATE_ABI
