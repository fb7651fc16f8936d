// The inverse of a matrix after a change of a few rows and the addition of a few.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// K, symmetric positive definite, becomes [K + P A P^T, P B; B^T P^T, D]: rows P change, and new rows are added as a
/// border. With H = P^T K^-1 P the new inverse is, by block elimination of the new rows and the formula of Sherman,
/// Morrison and Woodbury,
///   old, old: G - G P Q P^T G, G = K^-1, Q = (I + E H)^-1 E, E = A - B D^-1 B^T,
///   new, old: R P^T (old, old),    new, new: D^-1 + R P^T (old, old) P R^T,    R = -D^-1 B^T.
/// With H = L L^T the small matrix I + L^T E L is symmetric, and positive definite exactly when the new matrix is. Its
/// smallest eigenvalue is the fraction of stiffness left in the weakest direction: 1 without a change, 0 for a part
/// that comes off. (Hager 1989; bordered form as in Yeung, Crouch and Pothen 2016.)
struct BorderedUpdate {
  MatrixX q;               ///< changed x changed, symmetric
  MatrixX r;               ///< new x changed
  MatrixX border_inverse;  ///< D^-1
  double smallest = 1.0;   ///< smallest eigenvalue of the small matrix, estimated from above

  /// Throws not_positive_definite when the new matrix is singular to working precision. O(changed^3 + new^3).
  BorderedUpdate(const MatrixX& h, const MatrixX& a, const MatrixX& b, const MatrixX& d);

 private:
  static void require(bool holds, double value);
  /// Inverse iteration.
  static double smallest_eigenvalue(const Eigen::LLT<MatrixX>& left);
};

inline BorderedUpdate::BorderedUpdate(const MatrixX& h, const MatrixX& a, const MatrixX& b, const MatrixX& d) {
  MatrixX e = a;
  border_inverse = MatrixX::Zero(d.rows(), d.cols());
  r = MatrixX::Zero(d.rows(), a.cols());
  if (d.rows() > 0) {
    const Eigen::LLT<MatrixX> border(d);
    require(border.info() == Eigen::Success, 0.0);
    border_inverse = border.solve(MatrixX::Identity(d.rows(), d.cols()));
    r.noalias() = -border_inverse * b.transpose();
    e.noalias() += b * r;
  }
  if (a.rows() == 0) {
    q = e;
    return;
  }
  e = (0.5 * (e + e.transpose())).eval();
  const Eigen::LLT<MatrixX> half(h);
  require(half.info() == Eigen::Success, 0.0);
  const MatrixX l = half.matrixL();
  const MatrixX le = l.transpose() * e;
  MatrixX small_product = le * l;
  small_product.diagonal().array() += 1.0;
  const Eigen::LLT<MatrixX> left(small_product);
  require(left.info() == Eigen::Success, 0.0);
  smallest = smallest_eigenvalue(left);
  require(smallest > 1e-13, smallest);
  q = e - le.transpose() * left.solve(le);
  q = (0.5 * (q + q.transpose())).eval();
}

inline void BorderedUpdate::require(bool holds, double value) {
  if (holds) return;
  SetupProblem p;
  p.kind = SetupErrorKind::not_positive_definite;
  p.what = "after this cut a part of the body is not constrained";
  p.value = value;
  p.threshold = 1e-13;
  raise(std::move(p));
}

inline double BorderedUpdate::smallest_eigenvalue(const Eigen::LLT<MatrixX>& left) {
  VectorX x(left.rows());
  for (Index i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.5 * std::sin(1.0 + 7.0 * static_cast<double>(i));
  double value = 1.0;
  for (int k = 0; k < 8; ++k) {
    x /= x.norm();
    x = left.solve(x).eval();
    value = 1.0 / x.norm();
  }
  return std::min(value, 1.0);
}

}}}  // namespace palpate::detail
