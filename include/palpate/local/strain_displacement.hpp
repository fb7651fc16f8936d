// Strain from displacement.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The 6 x 3 block B_a of the strain-displacement matrix for a node with spatial gradient g [1/m] (thesis 3.16, 3.20):
/// strain = sum B_a u_a, Voigt order of core/voigt.hpp.
inline Eigen::Matrix<double, 6, 3> strain_displacement(const Vector3& g) noexcept {
  Eigen::Matrix<double, 6, 3> b = Eigen::Matrix<double, 6, 3>::Zero();
  b(voigt::xx, 0) = g[0];
  b(voigt::yy, 1) = g[1];
  b(voigt::zz, 2) = g[2];
  b(voigt::xy, 0) = g[1];
  b(voigt::xy, 1) = g[0];
  b(voigt::xz, 0) = g[2];
  b(voigt::xz, 2) = g[0];
  b(voigt::yz, 1) = g[2];
  b(voigt::yz, 2) = g[1];
  return b;
}

/// Strain of a displacement field given by nodal values u (nodes x 3 [m]) and spatial gradients (nodes x 3 [1/m]).
template <class Displacements, class Gradients>
Vector6 strain(const Eigen::MatrixBase<Displacements>& u, const Eigen::MatrixBase<Gradients>& gradient) noexcept {
  const Matrix3 h = u.transpose() * gradient;
  Vector6 e;
  e << h(0, 0), h(1, 1), h(2, 2), h(0, 1) + h(1, 0), h(0, 2) + h(2, 0), h(1, 2) + h(2, 1);
  return e;
}

}}  // namespace palpate
