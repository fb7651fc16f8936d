// Definitions of quad4.hpp.
#pragma once

#include <palpate/element/quad4.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Eigen::Vector4d Quad4::shape(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  return 0.25 * Eigen::Vector4d((1 - u) * (1 - v), (1 + u) * (1 - v), (1 + u) * (1 + v), (1 - u) * (1 + v));
}

PALPATE_INLINE Eigen::Matrix<double, 4, 2> Quad4::gradient(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  Eigen::Matrix<double, 4, 2> g;
  g << v - 1, u - 1, 1 - v, -1 - u, 1 + v, 1 + u, -1 - v, 1 - u;
  return 0.25 * g;
}

PALPATE_INLINE Eigen::Matrix<double, 4, 2> Quad4::reference_nodes() noexcept {
  Eigen::Matrix<double, 4, 2> x;
  x << -1, -1, 1, -1, 1, 1, -1, 1;
  return x;
}

}}  // namespace palpate
