// Definitions of tri6.hpp.
#pragma once

#include <palpate/element/tri6.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>
#include <palpate/element/tri3.hpp>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(TriangulatedFace<Tri6>);

PALPATE_INLINE Eigen::Matrix<double, 6, 1> Tri6::shape(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  Eigen::Matrix<double, 6, 1> n;
  for (int a = 0; a < 3; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    n[a] = l[a] * (2.0 * l[a] - 1.0);
    n[3 + a] = 4.0 * l[i] * l[j];
  }
  return n;
}

PALPATE_INLINE Eigen::Matrix<double, 6, 2> Tri6::gradient(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  const Eigen::Matrix<double, 3, 2> d = Tri3::gradient(xi);
  Eigen::Matrix<double, 6, 2> g;
  for (int a = 0; a < 3; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    for (int k = 0; k < 2; ++k) {
      g.coeffRef(a, k) = (4.0 * l[a] - 1.0) * d.coeff(a, k);
      g.coeffRef(3 + a, k) = 4.0 * (l[i] * d.coeff(j, k) + l[j] * d.coeff(i, k));
    }
  }
  return g;
}

PALPATE_INLINE Eigen::Matrix<double, 6, 2> Tri6::reference_nodes() noexcept {
  return detail::matrix_of_rows<6, 2>({{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}});
}

}}  // namespace palpate
