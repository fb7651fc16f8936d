// Smallest eigenpairs of a large symmetric pencil.
#pragma once

#include <palpate/linear/sparse_cholesky.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Eigenpairs K x = lambda M x of a pencil shifted to K - sigma M: largest theta = 1 / (lambda - sigma) first.
struct LanczosPairs {
  VectorX theta;
  MatrixX vectors;        ///< M-orthonormal, one per column
  double residual = 0.0;  ///< largest |A x - theta x|_M / theta of the pairs
  bool converged = false;
};

/// Block Lanczos on A = (K - sigma M)^-1 M, which is symmetric in the scalar product of M, with full
/// reorthogonalisation (Grimes, Lewis and Simon 1994) and restarts that keep the best Ritz vectors (thick restart, Wu
/// and Simon 2000). The block is wider than the number of wanted pairs, so that multiple eigenvalues are found with
/// their full multiplicity. The start is random with a fixed seed: the same problem gives the same result.
class BlockLanczos {
 public:
  /// `factor`: K - sigma M, positive definite. `mass`: the lower half of M, positive definite. Eigenvectors in the
  /// span of `known` are left out. Both references must outlive this.
  BlockLanczos(const SparseCholesky& factor, const SparseLower& mass, const MatrixX& known, Index wanted);

  /// Bytes it will allocate, small matrices not counted.
  static double bytes(Index size, Index known, Index wanted) noexcept;

  /// Runs until every wanted pair has |A x - theta x|_M <= tolerance * theta, or `most` block steps are done. A step
  /// costs one solve with as many right-hand sides as the block has columns, and the products of the block with the
  /// basis.
  LanczosPairs run(double tolerance, int most, const SetupLimits& limits);

 private:
  MatrixX random_block();
  MatrixX mass_times(const MatrixX& x) const;
  MatrixX basis_columns(Index first, Index count) const;
  MatrixX basis_products(Index first, Index count, const MatrixX& x) const;
  void append(MatrixX w);
  void append_column(double* v, double* mass_v, double before);
  MatrixX expand();
  LanczosPairs ritz_pairs(const MatrixX& coupling);
  MatrixX ritz_vectors(Index count) const;
  void restart();
  double* basis(Index column) noexcept { return basis_.data() + column * basis_.rows(); }

  const SparseCholesky& factor_;
  const SparseLower& mass_;
  Index wanted_, block_;
  MatrixX basis_;      // known vectors, then expanded ones, then the newest block
  MatrixX projected_;  // basis^T M A basis, without the known vectors
  MatrixX ritz_;
  VectorX values_;
  Index known_ = 0, expanded_ = 0, size_ = 0;
  std::uint64_t random_ = 20250101;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/block_lanczos.ipp>
#endif
