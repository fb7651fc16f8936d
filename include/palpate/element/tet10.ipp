// Definitions of tet10.hpp.
#pragma once

#include <palpate/element/tet10.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Eigen::Matrix<double, 10, 1> Tet10::shape(const Vector3& xi) noexcept {
  const Eigen::Vector4d l = Tet4::shape(xi);
  Eigen::Matrix<double, 10, 1> n;
  n.head<4>() = l.cwiseProduct(2.0 * l - Eigen::Vector4d::Ones());
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    n[4 + a] = 4.0 * l[i] * l[j];
  }
  return n;
}

PALPATE_INLINE Eigen::Matrix<double, 10, 3> Tet10::gradient(const Vector3& xi) noexcept {
  const Eigen::Vector4d l = Tet4::shape(xi);
  const Eigen::Matrix<double, 4, 3> d = Tet4::gradient(xi);
  Eigen::Matrix<double, 10, 3> g;
  for (int a = 0; a < 4; ++a) g.row(a) = (4.0 * l[a] - 1.0) * d.row(a);
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    g.row(4 + a) = 4.0 * (l[i] * d.row(j) + l[j] * d.row(i));
  }
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 10, 3> Tet10::reference_nodes() noexcept {
  Eigen::Matrix<double, 10, 3> x;
  x.topRows<4>() = Tet4::reference_nodes();
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    x.row(4 + a) = 0.5 * (x.row(i) + x.row(j));
  }
  return x;
}

}}  // namespace palpate
