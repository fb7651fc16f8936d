// Definitions of tet10.hpp.
#pragma once

#include <palpate/element/tet10.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(Element<Tet10>);

PALPATE_INLINE Eigen::Matrix<double, 10, 1> Tet10::shape(const Vector3& xi) noexcept {
  const Eigen::Vector4d l = Tet4::shape(xi);
  Eigen::Matrix<double, 10, 1> n;
  for (int a = 0; a < 4; ++a) n[a] = l[a] * (2.0 * l[a] - 1.0);
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
  for (int a = 0; a < 4; ++a)
    for (int k = 0; k < 3; ++k) g.coeffRef(a, k) = (4.0 * l[a] - 1.0) * d.coeff(a, k);
  for (int a = 0; a < 6; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    for (int k = 0; k < 3; ++k) g.coeffRef(4 + a, k) = 4.0 * (l[i] * d.coeff(j, k) + l[j] * d.coeff(i, k));
  }
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 10, 3> Tet10::reference_nodes() noexcept {
  return detail::matrix_of_rows<10, 3>({{0, 0, 0},
                                        {1, 0, 0},
                                        {0, 1, 0},
                                        {0, 0, 1},
                                        {0.5, 0, 0},
                                        {0.5, 0.5, 0},
                                        {0, 0.5, 0},
                                        {0, 0, 0.5},
                                        {0.5, 0, 0.5},
                                        {0, 0.5, 0.5}});
}

}}  // namespace palpate
