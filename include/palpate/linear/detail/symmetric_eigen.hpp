// Eigenvalues and eigenvectors of a small dense symmetric matrix.
#pragma once

#include <palpate/core/types.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// One column-major matrix that is overwritten by its eigenvectors, if `vectors`, with the diagonal d and the
/// subdiagonal e.
class SymmetricEigen {
 public:
  SymmetricEigen(MatrixX& matrix, VectorX& values, bool vectors)
      : v_(matrix.data()),
        d_(values.data()),
        n_(matrix.rows()),
        beside_(zeros(n_)),
        e_(beside_.data()),
        has_vectors_(vectors) {
    for (Index j = 0; j < n_; ++j) d_[j] = at(n_ - 1, j);
    for (Index i = n_ - 1; i > 0; --i) reflect(i);
    if (has_vectors_)
      accumulate();
    else
      for (Index j = 0; j < n_; ++j) d_[j] = at(j, j);
    for (Index i = 1; i < n_; ++i) e_[i - 1] = e_[i];
    e_[n_ - 1] = 0.0;
    for (Index l = 0; l < n_; ++l) iterate(l);
    sort();
  }

 private:
  double& at(Index i, Index j) noexcept { return v_[i + j * n_]; }
  double* column(Index j) noexcept { return v_ + j * n_; }

  /// Reduces row i to tridiagonal form; its entries left of the diagonal are in d.
  void reflect(Index i) noexcept {
    double scale = 0.0, h = 0.0;
    for (Index k = 0; k < i; ++k) scale += std::abs(d_[k]);
    if (scale == 0.0) {
      e_[i] = d_[i - 1];
      for (Index j = 0; j < i; ++j) {
        d_[j] = at(i - 1, j);
        at(i, j) = at(j, i) = 0.0;
      }
      d_[i] = 0.0;
      return;
    }
    for (Index k = 0; k < i; ++k) {
      d_[k] /= scale;
      h += d_[k] * d_[k];
    }
    const double f = d_[i - 1], g = f > 0.0 ? -std::sqrt(h) : std::sqrt(h);
    e_[i] = scale * g;
    h -= f * g;
    d_[i - 1] = f - g;
    apply(i, h);
    d_[i] = h;
  }

  /// Two-sided similarity with the reflection d of the first i rows and columns.
  void apply(Index i, double h) noexcept {
    std::copy_n(d_, i, column(i));
    std::fill_n(e_, i, 0.0);
    for (Index j = 0; j < i; ++j) {
      const Index below = i - j - 1;
      e_[j] += at(j, j) * d_[j] + dot(column(j) + j + 1, d_ + j + 1, below);
      add_scaled(e_ + j + 1, d_[j], column(j) + j + 1, below);
    }
    for (Index j = 0; j < i; ++j) e_[j] /= h;
    add_scaled(e_, -dot(e_, d_, i) / (h + h), d_, i);
    for (Index j = 0; j < i; ++j) {
      add_scaled(column(j) + j, -d_[j], e_ + j, i - j);
      add_scaled(column(j) + j, -e_[j], d_ + j, i - j);
    }
    for (Index j = 0; j < i; ++j) {
      d_[j] = at(i - 1, j);
      at(i, j) = 0.0;
    }
  }

  /// Forms the product of all reflections.
  void accumulate() noexcept {
    for (Index i = 0; i + 1 < n_; ++i) {
      at(n_ - 1, i) = at(i, i);
      at(i, i) = 1.0;
      const double h = d_[i + 1];
      double* const next = column(i + 1);
      if (h != 0.0) {
        for (Index k = 0; k <= i; ++k) d_[k] = next[k] / h;
        for (Index j = 0; j <= i; ++j) add_scaled(column(j), -dot(next, column(j), i + 1), d_, i + 1);
      }
      std::fill_n(next, i + 1, 0.0);
    }
    for (Index j = 0; j < n_; ++j) {
      d_[j] = at(n_ - 1, j);
      at(n_ - 1, j) = 0.0;
    }
    at(n_ - 1, n_ - 1) = 1.0;
    e_[0] = 0.0;
  }

  /// Implicit QL steps until e_[l] is negligible.
  void iterate(Index l) noexcept {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    largest_ = std::max(largest_, std::abs(d_[l]) + std::abs(e_[l]));
    Index m = l;
    while (m < n_ - 1 && std::abs(e_[m]) > eps * largest_) ++m;
    for (int step = 0; m > l && step < 60; ++step) {
      ql_step(l, m);
      if (std::abs(e_[l]) <= eps * largest_) break;
    }
    d_[l] += shifts_;
    e_[l] = 0.0;
  }

  void ql_step(Index l, Index m) noexcept {
    double g = d_[l], p = (d_[l + 1] - g) / (2.0 * e_[l]);
    const double root = p < 0.0 ? -std::hypot(p, 1.0) : std::hypot(p, 1.0);
    d_[l] = e_[l] / (p + root);
    d_[l + 1] = e_[l] * (p + root);
    const double next = d_[l + 1], shift = g - d_[l], after = e_[l + 1];
    for (Index i = l + 2; i < n_; ++i) d_[i] -= shift;
    shifts_ += shift;
    p = d_[m];
    double c = 1.0, c2 = 1.0, c3 = 1.0, s = 0.0, s2 = 0.0;
    for (Index i = m - 1; i >= l; --i) {
      c3 = c2;
      c2 = c;
      s2 = s;
      g = c * e_[i];
      const double h = c * p, r = std::hypot(p, e_[i]);
      e_[i + 1] = s * r;
      s = e_[i] / r;
      c = p / r;
      p = c * d_[i] - s * g;
      d_[i + 1] = h + s * (c * g + s * d_[i]);
      if (has_vectors_) rotate(column(i), column(i + 1), c, s);
    }
    p = -s * s2 * c3 * after * e_[l] / next;
    e_[l] = s * p;
    d_[l] = c * p;
  }

  void rotate(double* a, double* b, double c, double s) const noexcept {
    for (Index k = 0; k < n_; ++k) {
      const double h = b[k];
      b[k] = s * a[k] + c * h;
      a[k] = c * a[k] - s * h;
    }
  }

  void sort() noexcept {
    for (Index i = 0; i + 1 < n_; ++i) {
      const Index k = std::min_element(d_ + i, d_ + n_) - d_;
      if (k == i) continue;
      std::swap(d_[i], d_[k]);
      std::swap_ranges(column(i), column(i) + n_, column(k));
    }
  }

  double* v_;
  double* d_;
  Index n_;
  VectorX beside_;
  double* e_;
  bool has_vectors_;
  double largest_ = 0.0, shifts_ = 0.0;
};

/// Replaces a symmetric matrix (lower half read) by its orthonormal eigenvectors, one per column, and writes the
/// eigenvalues in ascending order. Householder reflections to tridiagonal form and implicit QL steps (Bowdler, Martin,
/// Reinsch and Wilkinson 1968; EISPACK tred2 and tql2). About 9 n^3 multiplications. The entries must be finite.
inline void symmetric_eigen(MatrixX& matrix, VectorX& values) {
  values.resize(matrix.rows());
  if (matrix.rows() > 0) SymmetricEigen(matrix, values, true);
}
/// Eigenvalues only; the matrix is overwritten. About 4/3 n^3 multiplications.
inline void symmetric_eigenvalues(MatrixX& matrix, VectorX& values) {
  values.resize(matrix.rows());
  if (matrix.rows() > 0) SymmetricEigen(matrix, values, false);
}

}}}  // namespace palpate::detail
