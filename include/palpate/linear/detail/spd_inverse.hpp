// The inverse of a dense symmetric positive definite matrix.
#pragma once

#include <palpate/core/executor.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Replaces the lower half of an SPD matrix by that of its inverse, recursively in halves: with S the Schur complement
/// of A_11, B_22 = S^-1, B_21 = -B_22 T, B_11 = A_11^-1 + T^T B_22 T, T = A_21 A_11^-1. About n^3 multiplications and
/// additions in total, almost all in matrix products; the workspace is a quarter of the matrix.
class SpdInverse {
 public:
  /// Throws not_positive_definite with `what` for a pivot that is not finite, not positive or below `threshold` times
  /// its own diagonal entry. The upper half is not read; afterwards the matrix is symmetric to the last bit. The
  /// threads share large products; the result has the same bits.
  static void invert(MatrixX& matrix, double threshold, const char* what, const SetupThreads& threads = 1);

 private:
  static constexpr Index leaf = 64;

  SpdInverse(MatrixX& matrix, double threshold, const SetupThreads& threads);
  void split(Index begin, Index size);
  void invert_leaf(Index begin, Index size);
  double* at(Index i, Index j) noexcept { return a_ + i + j * n_; }

  double* a_;
  Index n_;
  VectorX diagonal_;
  double threshold_;
  const SetupThreads& threads_;
  double worst_ = 1.0;  // smallest pivot so far, relative to its diagonal entry; NaN ends the inversion
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/spd_inverse.ipp>
#endif
