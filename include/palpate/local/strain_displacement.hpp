// Strain from displacement.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Strain, or stress, per displacement of one node: one column per component.
using StrainBlock = Eigen::Matrix<double, 6, 3>;

}  // namespace detail

/// The 6 x 3 block B_a of the strain-displacement matrix for a node with spatial gradient g [1/m] (thesis 3.16, 3.20):
/// strain = sum B_a u_a, Voigt order of core/voigt.hpp.
inline detail::StrainBlock strain_displacement(const Vector3& g) noexcept {
  return detail::matrix_of_rows<6, 3>({{g[0], 0, 0},       // xx
                                       {0, g[1], 0},       // yy
                                       {0, 0, g[2]},       // zz
                                       {g[1], g[0], 0},    // xy
                                       {g[2], 0, g[0]},    // xz
                                       {0, g[2], g[1]}});  // yz
}

namespace detail {

/// volume * D B: stress per displacement of a node, times volume.
inline StrainBlock stress_block(double volume, const Matrix6& d, const StrainBlock& b) noexcept {
  StrainBlock s;
  for (int j = 0; j < 3; ++j) {
    const double *e = b.data() + 6 * j, *row = d.data();
    for (int i = 0; i < 6; ++i, ++row)
      s.coeffRef(i, j) =
          volume * (row[0] * e[0] + row[6] * e[1] + row[12] * e[2] + row[18] * e[3] + row[24] * e[4] + row[30] * e[5]);
  }
  return s;
}

/// B^T S: nodal forces of the stresses S.
inline Matrix3 force_block(const StrainBlock& b, const StrainBlock& s) noexcept {
  Matrix3 f;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double *x = b.data() + 6 * i, *y = s.data() + 6 * j;
      f(i, j) = x[0] * y[0] + x[1] * y[1] + x[2] * y[2] + x[3] * y[3] + x[4] * y[4] + x[5] * y[5];
    }
  return f;
}

}  // namespace detail

/// Strain of a displacement field given by nodal values u (nodes x 3 [m]) and spatial gradients (nodes x 3 [1/m]).
template <class Displacements, class Gradients>
Vector6 strain(const Eigen::MatrixBase<Displacements>& u, const Eigen::MatrixBase<Gradients>& gradient) noexcept {
  const Matrix3 h = u.transpose() * gradient;
  return {h(0, 0), h(1, 1), h(2, 2), h(0, 1) + h(1, 0), h(0, 2) + h(2, 0), h(1, 2) + h(2, 1)};
}

}}  // namespace palpate
