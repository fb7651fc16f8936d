// Definitions of hex8.hpp.
#pragma once

#include <palpate/element/hex8.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Eigen::Matrix<double, 8, 1> Hex8::shape(const Vector3& xi) noexcept {
  const Eigen::Vector4d n = Quad4::shape(xi.head<2>());
  Eigen::Matrix<double, 8, 1> result;
  result << 0.5 * (1.0 - xi[2]) * n, 0.5 * (1.0 + xi[2]) * n;
  return result;
}

PALPATE_INLINE Eigen::Matrix<double, 8, 3> Hex8::gradient(const Vector3& xi) noexcept {
  const Eigen::Vector4d n = Quad4::shape(xi.head<2>());
  const Eigen::Matrix<double, 4, 2> d = Quad4::gradient(xi.head<2>());
  Eigen::Matrix<double, 8, 3> g;
  g << 0.5 * (1.0 - xi[2]) * d, -0.5 * n, 0.5 * (1.0 + xi[2]) * d, 0.5 * n;
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 8, 3> Hex8::reference_nodes() noexcept {
  Eigen::Matrix<double, 8, 3> x;
  x << Quad4::reference_nodes(), -Eigen::Vector4d::Ones(), Quad4::reference_nodes(), Eigen::Vector4d::Ones();
  return x;
}

}}  // namespace palpate
