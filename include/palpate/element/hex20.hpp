// The twenty-node hexahedron and its face, the eight-node quadrilateral.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/detail/serendipity.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Quadratic serendipity quadrilateral on [-1, 1]^2: the corners of Quad4, then the midpoints of its edges.
struct Quad8 {
  static constexpr int nodes = 8;
  static constexpr std::array<std::array<int, 2>, 4> edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};  ///< of nodes 4 to 7
  static constexpr std::array<std::array<int, 3>, 6> triangles{
      {{0, 4, 7}, {4, 1, 5}, {5, 2, 6}, {7, 6, 3}, {4, 5, 6}, {4, 6, 7}}};
  using Quadrature = QuadrilateralRule<3>;

  static Eigen::Matrix<double, 8, 1> shape(const Eigen::Vector2d& xi) noexcept {
    return serendipity::shape<8, 2>(reference_nodes(), xi);
  }
  static Eigen::Matrix<double, 8, 2> gradient(const Eigen::Vector2d& xi) noexcept {
    return serendipity::gradient<8, 2>(reference_nodes(), xi);
  }
  static Eigen::Matrix<double, 8, 2> reference_nodes() noexcept {
    return serendipity::with_middles<8, 2>(Quad4::reference_nodes(), edges);
  }
};

static_assert(TriangulatedFace<Quad8>);

/// Quadratic serendipity hexahedron on [-1, 1]^3: the corners of Hex8, then the midpoints of its `edges` in the order
/// of VTK and CalculiX: bottom, top, then the vertical edges (Gmsh uses a different order). Its edges may be curved.
/// Fully integrated, 3 x 3 x 3 points.
struct Hex20 {
  static constexpr int nodes = 20;
  static constexpr int order = 2;
  static constexpr double reference_volume = 8.0;
  static constexpr std::array<std::array<int, 2>, 12> edges{
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  static constexpr std::array<std::array<int, 8>, 6> faces{{{0, 3, 2, 1, 11, 10, 9, 8},
                                                            {4, 5, 6, 7, 12, 13, 14, 15},
                                                            {0, 1, 5, 4, 8, 17, 12, 16},
                                                            {1, 2, 6, 5, 9, 18, 13, 17},
                                                            {2, 3, 7, 6, 10, 19, 14, 18},
                                                            {3, 0, 4, 7, 11, 16, 15, 19}}};
  using Linear = Hex8;
  using Face = Quad8;
  using Quadrature = HexahedronRule<3>;
  using MassQuadrature = HexahedronRule<3>;

  static Eigen::Matrix<double, 20, 1> shape(const Vector3& xi) noexcept {
    return serendipity::shape<20, 3>(reference_nodes(), xi);
  }
  static Eigen::Matrix<double, 20, 3> gradient(const Vector3& xi) noexcept {
    return serendipity::gradient<20, 3>(reference_nodes(), xi);
  }
  static Eigen::Matrix<double, 20, 3> reference_nodes() noexcept {
    return serendipity::with_middles<20, 3>(Hex8::reference_nodes(), edges);
  }
};

static_assert(Element<Hex20>);

}}  // namespace palpate
