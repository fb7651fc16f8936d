// Smallest eigenpairs of a large symmetric pencil.
#pragma once

#include <palpate/linear/sparse_cholesky.hpp>

#include <Eigen/Eigenvalues>

namespace palpate { inline namespace PALPATE_ABI {

/// Eigenpairs K x = lambda M x of a pencil shifted to K - sigma M: largest theta = 1 / (lambda - sigma) first.
struct LanczosPairs {
  VectorX theta;
  MatrixX vectors;        ///< M-orthonormal, one per column
  double residual = 0.0;  ///< largest |A x - theta x|_M / theta of the pairs
  bool converged = false;
};

/// Block Lanczos on A = (K - sigma M)^-1 M, which is symmetric in the scalar product of M, with full
/// reorthogonalisation (Grimes, Lewis and Simon 1994) and restarts that keep the best Ritz vectors (thick restart, Wu
/// and Simon 2000). The block is wider than the number of pairs wanted, so that an eigenvalue of any multiplicity is
/// found as often as it occurs. The start is random with a fixed seed: the same problem gives the same answer. A
/// template, so that nobody pays for its compilation who does not use it.
template <class Factor = SparseCholesky>
class BlockLanczos {
 public:
  /// `factor` of K - sigma M, positive definite; `mass` the lower half of M, positive definite. Eigenvectors in the
  /// span of `known` are left out. Both references must outlive this.
  BlockLanczos(const Factor& factor, const SparseLower& mass, const MatrixX& known, Index wanted)
      : factor_(factor),
        mass_(mass),
        wanted_(wanted),
        block_(std::min(factor.size() - known.cols(), wanted + 4)),
        basis_(factor.size(), std::min(factor.size(), known.cols() + 4 * block_ + 24)) {
    append(known);
    known_ = expanded_ = size_;
    projected_ = MatrixX::Zero(basis_.cols() - known_, basis_.cols() - known_);
  }

  /// Bytes it will allocate, but for small matrices.
  static double bytes(Index size, Index known, Index wanted) noexcept {
    const double block = static_cast<double>(wanted + 4), n = static_cast<double>(size);
    return sizeof(double) * n * (static_cast<double>(known) + 10.0 * block + 24.0);
  }

  /// Runs until every wanted pair has |A x - theta x|_M <= tolerance * theta, or `most` block steps are done. Each
  /// costs a solve with as many right-hand sides as the block is wide, and products of it with the basis.
  LanczosPairs run(double tolerance, int most, const SetupLimits& limits) {
    append(factor_.solve(random_block()));
    LanczosPairs pairs;
    for (int step = 0; step < most && !pairs.converged; ++step) {
      limits.advance("natural frequencies", static_cast<double>(step) / static_cast<double>(most));
      if (size_ + block_ > basis_.cols() && basis_.cols() < basis_.rows()) restart();
      if (size_ == expanded_) append(factor_.solve(random_block()));  // the subspace is invariant, and too small
      const MatrixX coupling = expand();
      pairs = ritz_pairs(coupling);
      pairs.converged = pairs.theta.size() == wanted_ && pairs.residual <= tolerance;
    }
    pairs.vectors =
        basis_.middleCols(known_, expanded_ - known_) * ritz_.rightCols(pairs.theta.size()).rowwise().reverse();
    return pairs;
  }

 private:
  MatrixX random_block() {
    MatrixX x(basis_.rows(), block_);
    for (Index j = 0; j < x.cols(); ++j)
      for (Index i = 0; i < x.rows(); ++i) {  // Knuth's linear congruence; its high bits are good enough here
        random_ = 6364136223846793005u * random_ + 1442695040888963407u;
        x(i, j) = static_cast<double>(random_ >> 11) * 0x1p-52 - 1.0;
      }
    return x;
  }

  MatrixX mass_times(const MatrixX& x) const { return mass_.selfadjointView<Eigen::Lower>() * x; }

  /// Adds the columns to the basis, M-orthonormal; what lies in its span already is left out.
  void append(MatrixX w) {
    const MatrixX in_basis = basis_.leftCols(size_).transpose() * mass_times(w);
    const VectorX before = w.cwiseProduct(mass_times(w)).colwise().sum().cwiseSqrt().transpose();
    w.noalias() -= basis_.leftCols(size_) * in_basis;
    for (Index j = 0; j < w.cols() && size_ < basis_.cols(); ++j) {
      VectorX v = w.col(j), mv(v.size());
      for (int twice = 0; twice < 2; ++twice) {
        mv.noalias() = mass_.selfadjointView<Eigen::Lower>() * v;
        v.noalias() -= basis_.leftCols(size_) * (basis_.leftCols(size_).transpose() * mv).eval();
      }
      mv.noalias() = mass_.selfadjointView<Eigen::Lower>() * v;
      const double norm = std::sqrt(std::max(0.0, v.dot(mv)));
      if (norm > 1e-12 * before[j]) basis_.col(size_++) = v / norm;
    }
  }

  /// Applies A to the newest block. Returns Q^T M A X, of the block before X with the block after it.
  MatrixX expand() {
    const Index first = expanded_, width = size_ - first;
    const MatrixX w = factor_.solve(mass_times(basis_.middleCols(first, width)));
    const MatrixX mw = mass_times(w);
    const MatrixX h = basis_.middleCols(known_, size_ - known_).transpose() * mw;
    projected_.block(0, first - known_, h.rows(), width) = h;
    projected_.block(first - known_, 0, width, h.rows()) = h.transpose();
    expanded_ = size_;
    append(w);
    return basis_.middleCols(expanded_, size_ - expanded_).transpose() * mw;
  }

  /// The best pairs of the subspace, and how far A takes them out of it.
  LanczosPairs ritz_pairs(const MatrixX& coupling) {
    const Index m = expanded_ - known_, count = std::min(wanted_, m), width = coupling.cols();
    const MatrixX h = 0.5 * (projected_.topLeftCorner(m, m) + projected_.topLeftCorner(m, m).transpose());
    if (!h.allFinite()) raise(SetupErrorKind::non_finite, "the eigenvalue iteration met numbers that are not finite");
    const Eigen::SelfAdjointEigenSolver<MatrixX> small(h);
    ritz_ = small.eigenvectors();
    values_ = small.eigenvalues();
    LanczosPairs pairs;
    pairs.theta = values_.tail(count).reverse();
    for (Index i = 0; i < count; ++i)
      pairs.residual = std::max(pairs.residual, (coupling * ritz_.col(m - 1 - i).tail(width)).norm() / pairs.theta[i]);
    return pairs;
  }

  /// Keeps the best Ritz vectors and the block that has not been expanded.
  void restart() {
    const Index m = expanded_ - known_, keep = std::min(m, 2 * block_), next = size_ - expanded_;
    const MatrixX kept = basis_.middleCols(known_, m) * ritz_.rightCols(keep);
    const MatrixX after = basis_.middleCols(expanded_, next);
    basis_.middleCols(known_, keep) = kept;
    basis_.middleCols(known_ + keep, next) = after;
    projected_.setZero();
    projected_.topLeftCorner(keep, keep).diagonal() = values_.tail(keep);
    expanded_ = known_ + keep;
    size_ = expanded_ + next;
  }

  const Factor& factor_;
  const SparseLower& mass_;
  Index wanted_, block_;
  MatrixX basis_;      // known vectors, then expanded ones, then the newest block
  MatrixX projected_;  // basis^T M A basis, without the known
  MatrixX ritz_;
  VectorX values_;
  Index known_ = 0, expanded_ = 0, size_ = 0;
  std::uint64_t random_ = 20250101;
};

}}  // namespace palpate
