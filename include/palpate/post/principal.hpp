// Principal stresses and strains.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI {

/// Principal values of a symmetric tensor in descending order, and their directions.
struct Principal {
  Vector3 values = Vector3::Zero();          ///< descending; unit of the tensor
  Matrix3 directions = Matrix3::Identity();  ///< unit vectors, one per column in order of the values, right-handed
};

/// Principal values and directions of a symmetric tensor (the lower half is read): directions are orthogonal to
/// rounding also for repeated values, where they are an arbitrary basis of the eigenspace; the error of the values is a
/// few units in the last place of the largest. Any finite tensor, without overflow; NaN values for a tensor that is not
/// finite. No allocation, about 1 us.
Principal principal(const Matrix3& t) noexcept;

/// Principal values of a stress in the order of core/voigt.hpp [Pa].
Principal principal_stress(const Vector6& stress) noexcept;

/// Principal values of a strain in the order of core/voigt.hpp, with engineering shear.
Principal principal_strain(Vector6 strain) noexcept;

inline Principal principal(const Matrix3& t) noexcept {
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

inline Principal principal_stress(const Vector6& stress) noexcept {
  return principal(voigt::stress_tensor(stress));
}

inline Principal principal_strain(Vector6 strain) noexcept {
  strain.tail<3>() *= 0.5;
  return principal(voigt::stress_tensor(strain));
}

}}  // namespace palpate
