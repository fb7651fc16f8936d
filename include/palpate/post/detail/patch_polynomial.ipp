// Definitions of patch_polynomial.hpp.
#pragma once

#include <palpate/post/detail/patch_polynomial.hpp>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Vector3 PatchFrame::operator()(const Vector3& x) const noexcept {
  return map * (x - centre);
}

PALPATE_INLINE PatchFrame patch_frame(const std::vector<Vector3>& points) {
  PatchFrame frame{points.front(), Matrix3::Identity()};
  Vector3 shift = Vector3::Zero();
  for (const Vector3& p : points) shift += (p - points.front()) / static_cast<double>(points.size());
  frame.centre += shift;
  Matrix3 covariance = Matrix3::Zero();
  for (const Vector3& p : points)
    covariance += (p - frame.centre) * (p - frame.centre).transpose() / static_cast<double>(points.size());
  const Eigen::LLT<Matrix3> factor(covariance);
  const Matrix3 inverse = Matrix3(factor.matrixL()).inverse();
  if (factor.info() == Eigen::Success && inverse.allFinite())
    frame.map = inverse;
  else if (covariance.trace() > 0.0)
    frame.map /= std::sqrt(covariance.trace());
  return frame;
}

}}  // namespace palpate
