// Definitions of principal.hpp.
#pragma once

#include <palpate/post/detail/principal.hpp>
#include <palpate/core/voigt.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <limits>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Principal principal(const Matrix3& t) noexcept {
  Principal p;
  if (!t.allFinite()) {
    p.values.setConstant(std::numeric_limits<double>::quiet_NaN());
    return p;
  }
  const double scale = t.cwiseAbs().maxCoeff();
  if (scale == 0.0) return p;
  const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(t / scale);  // ascending values
  p.values = scale * eigen.eigenvalues().reverse();
  p.directions.leftCols<2>() = eigen.eigenvectors().rightCols<2>().rowwise().reverse();
  p.directions.col(2) = p.directions.col(0).cross(p.directions.col(1)).normalized();  // right-handed
  return p;
}

PALPATE_INLINE Principal principal_stress(const Vector6& stress) noexcept {
  return principal(voigt::stress_tensor(stress));
}

PALPATE_INLINE Principal principal_strain(Vector6 strain) noexcept {
  strain.tail<3>() *= 0.5;
  return principal(voigt::stress_tensor(strain));
}

}}  // namespace palpate
