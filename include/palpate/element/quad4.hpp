// The four-node quadrilateral: the face of Hex8.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/quadrature/tensor.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Bilinear quadrilateral on [-1, 1]^2 with nodes (-1, -1), (1, -1), (1, 1), (-1, 1): N = (1 + s u)(1 + t v) / 4.
struct Quad4 {
  static constexpr int nodes = 4;
  static constexpr std::array<std::array<int, 3>, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  using Quadrature = QuadrilateralRule<2>;

  static Eigen::Vector4d shape(const Eigen::Vector2d& xi) noexcept {
    const double u = xi[0], v = xi[1];
    return 0.25 * Eigen::Vector4d((1 - u) * (1 - v), (1 + u) * (1 - v), (1 + u) * (1 + v), (1 - u) * (1 + v));
  }

  static Eigen::Matrix<double, 4, 2> gradient(const Eigen::Vector2d& xi) noexcept {
    const double u = xi[0], v = xi[1];
    Eigen::Matrix<double, 4, 2> g;
    g << v - 1, u - 1, 1 - v, -1 - u, 1 + v, 1 + u, -1 - v, 1 - u;
    return 0.25 * g;
  }

  static Eigen::Matrix<double, 4, 2> reference_nodes() noexcept {
    Eigen::Matrix<double, 4, 2> x;
    x << -1, -1, 1, -1, 1, 1, -1, 1;
    return x;
  }
};

static_assert(TriangulatedFace<Quad4>);

}}  // namespace palpate
