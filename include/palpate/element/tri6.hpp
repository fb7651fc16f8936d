// The six-node triangle: the face of Tet10.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>
#include <palpate/element/tri3.hpp>
#include <palpate/quadrature/triangle.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Quadratic triangle on the unit triangle, L = (1 - u - v, u, v): corners L (2 L - 1), then 4 L_i L_j on the edges.
struct Tri6 {
  static constexpr int nodes = 6;
  static constexpr std::array<std::array<int, 2>, 3> edges{{{0, 1}, {1, 2}, {2, 0}}};  ///< of nodes 3, 4, 5
  static constexpr std::array<std::array<int, 3>, 4> triangles{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  using Quadrature = TriangleRule<4>;

  static Eigen::Matrix<double, 6, 1> shape(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 6, 2> gradient(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 6, 2> reference_nodes() noexcept;
};

static_assert(TriangulatedFace<Tri6>);

inline Eigen::Matrix<double, 6, 1> Tri6::shape(const Eigen::Vector2d& xi) noexcept {
  const Eigen::Vector3d l = Tri3::shape(xi);
  Eigen::Matrix<double, 6, 1> n;
  for (int a = 0; a < 3; ++a) {
    const auto [i, j] = edges[static_cast<std::size_t>(a)];
    n[a] = l[a] * (2.0 * l[a] - 1.0);
    n[3 + a] = 4.0 * l[i] * l[j];
  }
  return n;
}

inline Eigen::Matrix<double, 6, 2> Tri6::gradient(const Eigen::Vector2d& xi) noexcept {
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

inline Eigen::Matrix<double, 6, 2> Tri6::reference_nodes() noexcept {
  return detail::matrix_of_rows<6, 2>({{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}});
}

}}  // namespace palpate
