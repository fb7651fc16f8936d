// The inverse of a dense symmetric positive definite matrix.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Cholesky>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// Replaces the lower half of an SPD matrix by that of its inverse, in halves: with S the Schur complement of A_11,
/// B_22 = S^-1, B_21 = -B_22 T, B_11 = A_11^-1 + T^T B_22 T, T = A_21 A_11^-1. About n^3 multiplications and additions
/// in all, almost all of them in matrix products, and a quarter of the matrix as workspace.
class SpdInverse {
 public:
  /// Refuses a pivot that is not finite, not positive or below `threshold` of its own diagonal entry, as
  /// not_positive_definite with `what`. The upper half is not read; afterwards the matrix is symmetric to the last bit.
  static void invert(MatrixX& matrix, double threshold, const char* what) {
    SpdInverse inverse(matrix, threshold);
    inverse.split(0, matrix.rows());
    if (!(inverse.worst_ > threshold) || !matrix.diagonal().allFinite()) {
      SetupProblem p;
      p.kind = SetupErrorKind::not_positive_definite;
      p.what = what;
      p.value = inverse.worst_;
      p.threshold = threshold;
      raise(std::move(p));
    }
    matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
  }

 private:
  static constexpr Index leaf = 64;

  SpdInverse(MatrixX& matrix, double threshold) : a_(matrix), diagonal_(matrix.diagonal()), threshold_(threshold) {}

  void split(Index begin, Index size) {
    if (!(worst_ > threshold_)) return;
    if (size <= leaf) return invert_leaf(begin, size);
    const Index m = (size / 2 + 31) / 32 * 32, rest = size - m;
    auto a21 = a_.block(begin + m, begin, rest, m);
    auto a22 = a_.block(begin + m, begin + m, rest, rest);
    split(begin, m);
    const auto a11 = a_.block(begin, begin, m, m).template selfadjointView<Eigen::Lower>();
    MatrixX t(rest, m);
    t.noalias() = a21 * a11;
    a22.template triangularView<Eigen::Lower>() -= t * a21.transpose();
    split(begin + m, rest);
    a21.noalias() = a22.template selfadjointView<Eigen::Lower>() * t;
    a_.block(begin, begin, m, m).template triangularView<Eigen::Lower>() += t.transpose() * a21;
    a21 = -a21;
  }

  void invert_leaf(Index begin, Index size) {
    auto block = a_.block(begin, begin, size, size);
    MatrixX l = block;
    for (Index j = 0; j < size; ++j) {
      const double pivot = l(j, j) - l.row(j).head(j).squaredNorm();
      const double ratio = pivot / diagonal_[begin + j];
      if (!(std::isfinite(ratio) && ratio >= worst_)) worst_ = ratio;
      if (!(worst_ > threshold_)) return;
      l(j, j) = std::sqrt(pivot);
      for (Index i = j + 1; i < size; ++i) l(i, j) = (l(i, j) - l.row(i).head(j).dot(l.row(j).head(j))) / l(j, j);
    }
    MatrixX inverse = MatrixX::Identity(size, size);
    l.triangularView<Eigen::Lower>().solveInPlace(inverse);
    block.template triangularView<Eigen::Lower>() = inverse.transpose() * inverse;
  }

  MatrixX& a_;
  VectorX diagonal_;
  double threshold_;
  double worst_ = 1.0;  // smallest pivot so far, of its diagonal entry; NaN ends it
};

}}  // namespace palpate
