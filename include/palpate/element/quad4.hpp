// The four-node quadrilateral: the face of Hex8.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/element/quad4.ipp>
#endif
