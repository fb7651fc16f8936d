// The six-node triangle: the face of Tet10.
#pragma once

#include <palpate/element/tri3.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Quadratic triangle on the unit triangle, L = (1 - u - v, u, v): corners L (2 L - 1), then 4 L_i L_j on the edges.
struct Tri6 {
  static constexpr int nodes = 6;
  static constexpr std::array<std::array<int, 2>, 3> edges{{{0, 1}, {1, 2}, {2, 0}}};  ///< of nodes 3, 4, 5
  static constexpr std::array<std::array<int, 3>, 4> triangles{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  using Quadrature = TriangleRule<4>;

  static Eigen::Matrix<double, 6, 1> shape(const Eigen::Vector2d& xi) noexcept {
    const Eigen::Vector3d l = Tri3::shape(xi);
    Eigen::Matrix<double, 6, 1> n;
    n << l.cwiseProduct(2.0 * l - Eigen::Vector3d::Ones()), 4.0 * l[0] * l[1], 4.0 * l[1] * l[2], 4.0 * l[2] * l[0];
    return n;
  }

  static Eigen::Matrix<double, 6, 2> gradient(const Eigen::Vector2d& xi) noexcept {
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

  static Eigen::Matrix<double, 6, 2> reference_nodes() noexcept {
    Eigen::Matrix<double, 6, 2> x;
    x << 0, 0, 1, 0, 0, 1, 0.5, 0, 0.5, 0.5, 0, 0.5;
    return x;
  }
};

static_assert(TriangulatedFace<Tri6>);

}}  // namespace palpate
