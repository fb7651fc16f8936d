// The one Voigt order of the library: xx, yy, zz, xy, xz, yz with engineering shear (gamma = 2 epsilon).
// It is the thesis' order (eqs. 3.13, 3.16) and that of Abaqus and CalculiX; every strain operator, elasticity matrix
// and output uses it.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace voigt {

inline constexpr int xx = 0, yy = 1, zz = 2, xy = 3, xz = 4, yz = 5;

/// Symmetric stress tensor [Pa] from its Voigt vector. No allocation.
inline Matrix3 stress_tensor(const Vector6& s) {
  return Matrix3{{s[xx], s[xy], s[xz]}, {s[xy], s[yy], s[yz]}, {s[xz], s[yz], s[zz]}};
}

/// Voigt vector of a symmetric stress tensor.
inline Vector6 stress_vector(const Matrix3& t) {
  return Vector6{{t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(0, 2), t(1, 2)}};
}

/// Voigt vector of a symmetric small-strain tensor; shear components are doubled.
inline Vector6 strain_vector(const Matrix3& e) {
  return Vector6{{e(0, 0), e(1, 1), e(2, 2), 2.0 * e(0, 1), 2.0 * e(0, 2), 2.0 * e(1, 2)}};
}

/// The 6 x 6 matrix T that rotates a stress: stress_vector(R s R^T) = T stress_vector(s). Strains are rotated by its
/// inverse transpose, an elasticity matrix by T D T^T. `r` is a rotation.
inline Matrix6 stress_rotation(const Matrix3& r) {
  Matrix6 t;
  for (int k = 0; k < 6; ++k) {
    Vector6 unit = Vector6::Zero();
    unit[k] = 1.0;
    const Vector6 rotated = stress_vector(r * stress_tensor(unit) * r.transpose());
    for (int i = 0; i < 6; ++i) t(i, k) = rotated[i];
  }
  return t;
}

/// Equivalent (von Mises) stress [Pa], always >= 0.
inline double von_mises(const Vector6& s) {
  const double a = s[xx] - s[yy], b = s[yy] - s[zz], c = s[zz] - s[xx];
  const double shear = s[xy] * s[xy] + s[xz] * s[xz] + s[yz] * s[yz];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * shear);
}

}}}  // namespace palpate::voigt
