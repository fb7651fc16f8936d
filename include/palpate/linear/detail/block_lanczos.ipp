// Definitions of block_lanczos.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/linear/detail/block_lanczos.hpp>
#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/linear/detail/symmetric_eigen.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// y = m x for one column; entries above the diagonal are ignored.
inline void sparse_symmetric_product(const SparseLower& m, const double* x, double* y) noexcept {
  const Index* const start = m.outerIndexPtr();
  const Index* const row = m.innerIndexPtr();
  const double* const value = m.valuePtr();
  std::fill_n(y, m.rows(), 0.0);
  for (Index j = 0; j < m.cols(); ++j) {
    double sum = 0.0;
    for (Index p = start[j]; p < start[j + 1]; ++p) {
      if (row[p] < j) continue;
      sum += value[p] * x[row[p]];
      if (row[p] > j) y[row[p]] += value[p] * x[j];
    }
    y[j] += sum;
  }
}

inline Target whole_target(MatrixX& m) noexcept {
  return {m.data(), m.rows(), m.cols(), m.rows()};
}

PALPATE_INLINE BlockLanczos::BlockLanczos(const SparseCholesky& factor, const SparseLower& mass, const MatrixX& known,
                                          Index wanted)
    : factor_(factor),
      mass_(mass),
      wanted_(wanted),
      block_(std::min(factor.size() - known.cols(), wanted + 4)),
      basis_(factor.size(), std::min(factor.size(), known.cols() + 4 * block_ + 24)) {
  append(known);
  known_ = expanded_ = size_;
  projected_.resize(basis_.cols() - known_, basis_.cols() - known_);
  std::fill_n(projected_.data(), projected_.size(), 0.0);
}

PALPATE_INLINE double BlockLanczos::bytes(Index size, Index known, Index wanted) noexcept {
  const double block = static_cast<double>(wanted + 4), n = static_cast<double>(size);
  return sizeof(double) * n * (static_cast<double>(known) + 10.0 * block + 24.0);
}

PALPATE_INLINE LanczosPairs BlockLanczos::run(double tolerance, int most, const SetupLimits& limits) {
  append(factor_.solve(random_block()));
  LanczosPairs pairs;
  for (int step = 0; step < most && !pairs.converged; ++step) {
    limits.advance("natural frequencies", static_cast<double>(step) / static_cast<double>(most));
    if (size_ + block_ > basis_.cols() && basis_.cols() < basis_.rows()) restart();
    if (size_ == expanded_) append(factor_.solve(random_block()));  // the subspace is invariant, but too small
    const MatrixX coupling = expand();
    pairs = ritz_pairs(coupling);
    pairs.converged = pairs.theta.size() == wanted_ && pairs.residual <= tolerance;
  }
  const MatrixX rising = ritz_vectors(pairs.theta.size());
  pairs.vectors.resize(rising.rows(), rising.cols());
  for (Index j = 0; j < rising.cols(); ++j)
    std::copy_n(rising.data() + (rising.cols() - 1 - j) * rising.rows(), rising.rows(),
                pairs.vectors.data() + j * rising.rows());
  return pairs;
}

PALPATE_INLINE MatrixX BlockLanczos::random_block() {
  MatrixX x(basis_.rows(), block_);
  for (Index i = 0; i < x.size(); ++i) {  // Knuth's linear congruential generator; its high bits are good enough here
    random_ = 6364136223846793005u * random_ + 1442695040888963407u;
    x.data()[i] = static_cast<double>(random_ >> 11) * 0x1p-52 - 1.0;
  }
  return x;
}

PALPATE_INLINE MatrixX BlockLanczos::mass_times(const MatrixX& x) const {
  MatrixX y(x.rows(), x.cols());
  for (Index j = 0; j < x.cols(); ++j)
    sparse_symmetric_product(mass_, x.data() + j * x.rows(), y.data() + j * x.rows());
  return y;
}

PALPATE_INLINE MatrixX BlockLanczos::basis_columns(Index first, Index count) const {
  MatrixX columns(basis_.rows(), count);
  std::copy_n(basis_.data() + first * basis_.rows(), columns.size(), columns.data());
  return columns;
}

/// Scalar products of `count` basis vectors, from `first` on, with the columns of x.
PALPATE_INLINE MatrixX BlockLanczos::basis_products(Index first, Index count, const MatrixX& x) const {
  const Index n = basis_.rows();
  MatrixX h(count, x.cols());
  std::fill_n(h.data(), h.size(), 0.0);
  add_product(whole_target(h), 1.0, {basis_.data() + first * n, n, detail::Read::transposed}, {x.data(), n}, n);
  return h;
}

/// Adds the columns to the basis, M-orthonormalised; drops columns that are already in its span.
PALPATE_INLINE void BlockLanczos::append(MatrixX w) {
  const Index n = w.rows(), columns = w.cols();
  const MatrixX mw = mass_times(w);
  const MatrixX in_basis = basis_products(0, size_, mw);
  std::vector<double> before(static_cast<std::size_t>(columns)), mv(static_cast<std::size_t>(n));
  for (Index j = 0; j < columns; ++j)
    before[static_cast<std::size_t>(j)] = std::sqrt(dot(w.data() + j * n, mw.data() + j * n, n));
  add_product(whole_target(w), -1.0, {basis_.data(), n}, {in_basis.data(), size_}, size_);
  for (Index j = 0; j < columns && size_ < basis_.cols(); ++j)
    append_column(w.data() + j * n, mv.data(), before[static_cast<std::size_t>(j)]);
}

/// Orthogonalises v against the basis and appends the remainder, unless it is negligible relative to `before`.
PALPATE_INLINE void BlockLanczos::append_column(double* v, double* mass_v, double before) {
  const Index n = basis_.rows();
  std::vector<double> part(static_cast<std::size_t>(size_));
  for (int twice = 0; twice < 2; ++twice) {
    sparse_symmetric_product(mass_, v, mass_v);
    transposed_product(basis_.data(), n, size_, mass_v, part.data());
    subtract_product(basis_.data(), n, size_, part.data(), v);
  }
  sparse_symmetric_product(mass_, v, mass_v);
  const double norm = std::sqrt(std::max(0.0, dot(v, mass_v, n)));
  if (!(norm > 1e-12 * before)) return;
  for (Index i = 0; i < n; ++i) basis(size_)[i] = v[i] / norm;
  ++size_;
}

/// Applies A to the newest block X. Returns Q^T M A X, the coupling of X with the next block.
PALPATE_INLINE MatrixX BlockLanczos::expand() {
  const Index first = expanded_, width = size_ - first;
  const MatrixX w = factor_.solve(mass_times(basis_columns(first, width)));
  const MatrixX mw = mass_times(w);
  const MatrixX h = basis_products(known_, size_ - known_, mw);
  for (Index j = 0; j < width; ++j)
    for (Index i = 0; i < h.rows(); ++i) projected_(i, first - known_ + j) = h(i, j);
  for (Index j = 0; j < width; ++j)
    for (Index i = 0; i < h.rows(); ++i) projected_(first - known_ + j, i) = h(i, j);
  expanded_ = size_;
  append(w);
  return basis_products(expanded_, size_ - expanded_, mw);
}

/// The best Ritz pairs of the subspace, and their residuals.
PALPATE_INLINE LanczosPairs BlockLanczos::ritz_pairs(const MatrixX& coupling) {
  const Index m = expanded_ - known_, count = std::min(wanted_, m), width = coupling.cols();
  ritz_.resize(m, m);
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i < m; ++i) {
      ritz_(i, j) = 0.5 * (projected_(i, j) + projected_(j, i));
      if (!std::isfinite(ritz_(i, j)))
        raise(SetupErrorKind::non_finite, "the eigenvalue iteration produced non-finite numbers");
    }
  symmetric_eigen(ritz_, values_);
  LanczosPairs pairs;
  pairs.theta.resize(count);
  std::vector<double> out(static_cast<std::size_t>(coupling.rows()));
  for (Index i = 0; i < count; ++i) {
    pairs.theta[i] = values_[m - 1 - i];
    std::fill(out.begin(), out.end(), 0.0);
    for (Index k = 0; k < width; ++k)
      add_scaled(out.data(), ritz_(m - width + k, m - 1 - i), coupling.data() + k * coupling.rows(), coupling.rows());
    const double left = std::sqrt(dot(out.data(), out.data(), coupling.rows()));
    pairs.residual = std::max(pairs.residual, left / pairs.theta[i]);
  }
  return pairs;
}

/// The Ritz vectors of the `count` largest values, in ascending order.
PALPATE_INLINE MatrixX BlockLanczos::ritz_vectors(Index count) const {
  const Index n = basis_.rows(), m = ritz_.rows();
  MatrixX vectors(n, count);
  std::fill_n(vectors.data(), vectors.size(), 0.0);
  add_product(whole_target(vectors), 1.0, {basis_.data() + known_ * n, n}, {ritz_.data() + (m - count) * m, m}, m);
  return vectors;
}

/// Keeps the best Ritz vectors and the newest block, which is not expanded yet.
PALPATE_INLINE void BlockLanczos::restart() {
  const Index m = expanded_ - known_, keep = std::min(m, 2 * block_), next = size_ - expanded_;
  const MatrixX kept = ritz_vectors(keep), after = basis_columns(expanded_, next);
  std::copy_n(kept.data(), kept.size(), basis(known_));
  std::copy_n(after.data(), after.size(), basis(known_ + keep));
  std::fill_n(projected_.data(), projected_.size(), 0.0);
  for (Index i = 0; i < keep; ++i) projected_(i, i) = values_[m - keep + i];
  expanded_ = known_ + keep;
  size_ = expanded_ + next;
}

}}}  // namespace palpate::detail
