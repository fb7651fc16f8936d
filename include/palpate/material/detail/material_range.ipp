// Definitions of material_range.hpp.
#pragma once

#include <palpate/material/detail/material_range.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Of a symmetric matrix.
inline bool is_positive_definite(const Matrix3& a) noexcept {
  return a(0, 0) > 0.0 && a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0) > 0.0 && a.determinant() > 0.0;
}

/// Q_ik = A_ijkl N_j N_l
inline Matrix3 acoustic_tensor(const Matrix9& tangent, const Vector3& along) noexcept {
  Matrix3 q = Matrix3::Zero();
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l) q += (along[j] * along[l]) * tangent.block<3, 3>(3 * j, 3 * l);
  return q;
}

/// A^T T A, without Eigen's products, which take seconds to compile.
inline Matrix3 congruent(const Matrix9& t, const Eigen::Matrix<double, 9, 3>& a) noexcept {
  Matrix3 result = Matrix3::Zero();
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 9; ++k) {
      double sum = 0.0;
      for (int l = 0; l < 9; ++l) sum += t(k, l) * a(l, j);
      for (int i = 0; i < 3; ++i) result(i, j) += a(k, i) * sum;
    }
  return result;
}

PALPATE_INLINE bool is_stable(const Tensor3<double>& f, const Matrix9& tangent) noexcept {
  constexpr double compressed = 0.9, flat = 1e-6;
  const Matrix3 gradient = matrix3(f);
  Eigen::SelfAdjointEigenSolver<Matrix3> principal;
  principal.computeDirect(gradient.transpose() * gradient);
  const Matrix3& axes = principal.eigenvectors();
  const Vector3 stretch = principal.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (!(stretch[0] > flat * stretch[2])) return false;
  if (stretch.prod() < compressed) {
    Eigen::Matrix<double, 9, 3> change;  // of F, by the relative change of each stretch
    for (int i = 0; i < 3; ++i) {
      const Vector3 axis = axes.col(i), moved = gradient * axis;
      Matrix3 along;
      for (int k = 0; k < 3; ++k) along.col(k) = axis[k] * moved;
      change.col(i) = vector9(tensor3<double>(along));
    }
    if (!is_positive_definite(congruent(tangent, change))) return false;
  }
  constexpr int middle =
      13;  // of the 27 directions with components -1, 0, 1: those before it are opposite to the others
  for (int n = middle + 1; n < 27; ++n) {
    const Vector3 direction(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    if (!is_positive_definite(acoustic_tensor(tangent, axes * direction)) ||
        !is_positive_definite(acoustic_tensor(tangent, axes * direction.cwiseProduct(stretch))))
      return false;
  }
  return true;
}

}}}  // namespace palpate::detail
