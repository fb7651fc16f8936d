// Definitions of bordered_update.hpp.
#pragma once

#include <palpate/cut/detail/bordered_update.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE BorderedUpdate::BorderedUpdate(const MatrixX& h, const MatrixX& a, const MatrixX& b, const MatrixX& d) {
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
  MatrixX small = le * l;
  small.diagonal().array() += 1.0;
  const Eigen::LLT<MatrixX> left(small);
  require(left.info() == Eigen::Success, 0.0);
  smallest = smallest_eigenvalue(left);
  require(smallest > 1e-13, smallest);
  q = e - le.transpose() * left.solve(le);
  q = (0.5 * (q + q.transpose())).eval();
}

PALPATE_INLINE void BorderedUpdate::require(bool holds, double value) {
  if (holds) return;
  SetupProblem p;
  p.kind = SetupErrorKind::not_positive_definite;
  p.what = "after this cut a part of the body is not constrained";
  p.value = value;
  p.threshold = 1e-13;
  raise(std::move(p));
}

PALPATE_INLINE double BorderedUpdate::smallest_eigenvalue(const Eigen::LLT<MatrixX>& left) {
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

}}  // namespace palpate
