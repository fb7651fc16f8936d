// The six-node triangle: the face of Tet10.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/element/tri6.ipp>
#endif
