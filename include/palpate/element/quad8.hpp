// The eight-node quadrilateral: the face of Hex20.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/element/detail/serendipity.hpp>
#include <palpate/element/quad4.hpp>
#include <palpate/quadrature/tensor.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Quadratic serendipity quadrilateral on [-1, 1]^2: the corners of Quad4, then the midpoints of its edges.
struct Quad8 {
  static constexpr int nodes = 8;
  static constexpr std::array<std::array<int, 2>, 4> edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};  ///< of nodes 4 to 7
  static constexpr std::array<std::array<int, 3>, 6> triangles{
      {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {7, 6, 3}, {4, 5, 6}, {4, 6, 7}}};
  using Quadrature = QuadrilateralRule<3>;

  static Eigen::Matrix<double, 8, 1> shape(const Eigen::Vector2d& xi) noexcept;
  static Eigen::Matrix<double, 8, 2> gradient(const Eigen::Vector2d& xi) noexcept;
  static Eigen::Matrix<double, 8, 2> reference_nodes() noexcept;
};

static_assert(TriangulatedFace<Quad8>);

inline Eigen::Matrix<double, 8, 1> Quad8::shape(const Eigen::Vector2d& xi) noexcept {
  return serendipity::shape<8, 2>(reference_nodes(), xi);
}

inline Eigen::Matrix<double, 8, 2> Quad8::gradient(const Eigen::Vector2d& xi) noexcept {
  return serendipity::gradient<8, 2>(reference_nodes(), xi);
}

inline Eigen::Matrix<double, 8, 2> Quad8::reference_nodes() noexcept {
  return serendipity::with_middles<8, 2>(Quad4::reference_nodes(), edges);
}

}}  // namespace palpate
