// Definitions of patch_recovery.hpp.
#pragma once

#include <palpate/post/patch_recovery.hpp>

#include <Eigen/QR>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE Vector3 PatchFrame::operator()(const Vector3& x) const noexcept {
  return map * (x - centre);
}

/// The inverse of the lower Cholesky factor of a symmetric matrix; not finite if the matrix is not positive definite.
inline Matrix3 inverse_factor(const Matrix3& a) noexcept {
  const double l00 = std::sqrt(a(0, 0)), l10 = a(1, 0) / l00, l20 = a(2, 0) / l00;
  const double l11 = std::sqrt(a(1, 1) - l10 * l10), l21 = (a(2, 1) - l20 * l10) / l11;
  const double l22 = std::sqrt(a(2, 2) - l20 * l20 - l21 * l21);
  Matrix3 inverse = Matrix3::Zero();
  inverse(0, 0) = 1.0 / l00;
  inverse(1, 0) = -l10 / (l00 * l11);
  inverse(1, 1) = 1.0 / l11;
  inverse(2, 0) = (l10 * l21 / l11 - l20) / (l00 * l22);
  inverse(2, 1) = -l21 / (l11 * l22);
  inverse(2, 2) = 1.0 / l22;
  return inverse;
}

PALPATE_INLINE PatchFrame patch_frame(const std::vector<Vector3>& points) {
  PatchFrame frame{points.front(), Matrix3::Identity()};
  Vector3 shift = Vector3::Zero();
  for (const Vector3& p : points) shift += (p - points.front()) / static_cast<double>(points.size());
  frame.centre += shift;
  Matrix3 covariance = Matrix3::Zero();
  for (const Vector3& p : points)
    covariance += (p - frame.centre) * (p - frame.centre).transpose() / static_cast<double>(points.size());
  const Matrix3 inverse = inverse_factor(covariance);
  if (inverse.allFinite())
    frame.map = inverse;
  else if (covariance.trace() > 0.0)
    frame.map /= std::sqrt(covariance.trace());
  return frame;
}

PALPATE_INLINE PatchPolynomial::PatchPolynomial(int degree, const PatchFrame& frame, const Vector3& node,
                                                const std::vector<Vector3>& points, const StressColumns& stress,
                                                int oversampling)
    : terms_(degree == 1 ? 3 : most_terms), frame_(frame) {
  constexpr double nearest = 0.01;      // keeps the weights finite
  constexpr double least_pivot = 0.03;  // of the largest: smaller ones indicate linearly dependent terms
  const auto count = static_cast<Index>(points.size());
  VectorX weights(count);
  MatrixX a(count, terms_);
  for (Index i = 0; i < count; ++i) {
    const Vector3& point = points[static_cast<std::size_t>(i)];
    weights[i] = 1.0 / ((frame.map * (point - node)).norm() + nearest);
    a.row(i) = powers(point).transpose();
  }
  weights /= weights.sum();
  mean_ = stress * weights;
  mean_powers_ = a.transpose() * weights;
  const VectorX roots = weights.cwiseSqrt();
  a = roots.asDiagonal() * (a.rowwise() - mean_powers_.transpose());
  Eigen::CompleteOrthogonalDecomposition<MatrixX> fit;
  fit.setThreshold(least_pivot);
  fit.compute(a);
  complete_ = fit.rank() == terms_ && count >= oversampling * (terms_ + 1);
  const MatrixX differences = roots.asDiagonal() * (stress.colwise() - mean_).transpose();
  slopes_ = fit.solve(differences);
}

PALPATE_INLINE Vector6 PatchPolynomial::operator()(const Vector3& x) const noexcept {
  return mean_ + slopes_.transpose() * (powers(x) - mean_powers_);
}

/// x, y, z, and with degree 2 their products, weighted so that the norm of their factors does not depend on the axes.
PALPATE_INLINE PatchPolynomial::Terms PatchPolynomial::powers(const Vector3& x) const noexcept {
  const Vector3 y = frame_(x);
  Terms p(terms_);
  p.head<3>() = y;
  if (terms_ == most_terms) {
    const double weight = std::sqrt(2.0);
    p.tail<6>() << y.cwiseAbs2(), weight * y[0] * y[1], weight * y[0] * y[2], weight * y[1] * y[2];
  }
  return p;
}

}}}  // namespace palpate::detail
