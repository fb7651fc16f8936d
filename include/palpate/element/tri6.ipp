// Definitions of tri6.hpp.
#pragma once

#include <palpate/element/tri6.hpp>
#include <palpate/element/tri3.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Eigen::Matrix<double, 6, 1> Tri6::shape(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  Eigen::Matrix<double, 6, 1> n;
  n << l.cwiseProduct(2.0 * l - Eigen::Vector3d::Ones()), 4.0 * l[0] * l[1], 4.0 * l[1] * l[2], 4.0 * l[2] * l[0];
  return n;
}

PALPATE_INLINE Eigen::Matrix<double, 6, 2> Tri6::gradient(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  const Eigen::Matrix<double, 3, 2> d = Tri3::gradient(xi);
  Eigen::Matrix<double, 6, 2> g;
  for (int a = 0; a < 3; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    g.row(a) = (4.0 * l[a] - 1.0) * d.row(a);
    g.row(3 + a) = 4.0 * (l[i] * d.row(j) + l[j] * d.row(i));
  }
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 6, 2> Tri6::reference_nodes() noexcept {
  Eigen::Matrix<double, 6, 2> x;
  x << 0, 0, 1, 0, 0, 1, 0.5, 0, 0.5, 0.5, 0, 0.5;
  return x;
}

}}  // namespace palpate
