// The four-node quadrilateral: the face of Hex8.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/element/detail/matrix_of_rows.hpp>
#include <palpate/quadrature/tensor.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Bilinear quadrilateral on [-1, 1]^2 with nodes (-1, -1), (1, -1), (1, 1), (-1, 1): N = (1 + s u)(1 + t v) / 4.
struct Quad4 {
  static constexpr int nodes = 4;
  static constexpr std::array<std::array<int, 3>, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  using Quadrature = QuadrilateralRule<2>;

  static Eigen::Vector4d shape(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 4, 2> gradient(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 4, 2> reference_nodes() noexcept;
};

static_assert(TriangulatedFace<Quad4>);

inline Eigen::Vector4d Quad4::shape(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  return {0.25 * ((1 - u) * (1 - v)), 0.25 * ((1 + u) * (1 - v)), 0.25 * ((1 + u) * (1 + v)),
          0.25 * ((1 - u) * (1 + v))};
}

inline Eigen::Matrix<double, 4, 2> Quad4::gradient(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  return detail::matrix_of_rows<4, 2>({{0.25 * (v - 1), 0.25 * (u - 1)},
                                       {0.25 * (1 - v), 0.25 * (-1 - u)},
                                       {0.25 * (1 + v), 0.25 * (1 + u)},
                                       {0.25 * (-1 - v), 0.25 * (1 - u)}});
}

inline Eigen::Matrix<double, 4, 2> Quad4::reference_nodes() noexcept {
  return detail::matrix_of_rows<4, 2>({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
}

}}  // namespace palpate
