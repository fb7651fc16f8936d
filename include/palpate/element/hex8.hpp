// The eight-node hexahedron and its face, the four-node quadrilateral.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/types.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Bilinear quadrilateral on [-1, 1]^2 with nodes (-1, -1), (1, -1), (1, 1), (-1, 1): N = (1 + s u)(1 + t v) / 4.
struct Quad4 {
  static constexpr int nodes = 4;
  static constexpr std::array<std::array<int, 3>, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  using Quadrature = QuadrilateralRule<2>;

  static Eigen::Vector4d shape(const Eigen::Vector2d& xi) noexcept {
    const double u = xi[0], v = xi[1];
    return {0.25 * ((1 - u) * (1 - v)), 0.25 * ((1 + u) * (1 - v)), 0.25 * ((1 + u) * (1 + v)),
            0.25 * ((1 - u) * (1 + v))};
  }

  static Eigen::Matrix<double, 4, 2> gradient(const Eigen::Vector2d& xi) noexcept;

  static Eigen::Matrix<double, 4, 2> reference_nodes() noexcept {
    return detail::matrix_of_rows<4, 2>({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  }
};

static_assert(TriangulatedFace<Quad4>);

inline Eigen::Matrix<double, 4, 2> Quad4::gradient(const Eigen::Vector2d& xi) noexcept {
  const double u = xi[0], v = xi[1];
  return detail::matrix_of_rows<4, 2>({{0.25 * (v - 1), 0.25 * (u - 1)},
                                       {0.25 * (1 - v), 0.25 * (-1 - u)},
                                       {0.25 * (1 + v), 0.25 * (1 + u)},
                                       {0.25 * (-1 - v), 0.25 * (1 - u)}});
}

/// Trilinear hexahedron on [-1, 1]^3: bottom (w = -1) counter-clockwise seen from above, then top; 2 x 2 x 2 points.
/// The standard, fully integrated brick. It locks near incompressibility, and results above `locking_poisson_ratio` are
/// flagged.
struct Hex8 {
  static constexpr int nodes = 8;
  static constexpr int order = 1;
  static constexpr double reference_volume = 8.0;
  static constexpr double locking_poisson_ratio = 0.4;  // at 0.45 up to 18 % too stiff in bending
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  using Face = Quad4;
  using Quadrature = HexahedronRule<2>;
  using MassQuadrature = HexahedronRule<2>;

  static Eigen::Matrix<double, 8, 1> shape(const Vector3& xi) noexcept;

  static Eigen::Matrix<double, 8, 3> gradient(const Vector3& xi) noexcept;

  static Eigen::Matrix<double, 8, 3> reference_nodes() noexcept {
    return detail::matrix_of_rows<8, 3>(
        {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  }
};

static_assert(Element<Hex8>);

inline Eigen::Matrix<double, 8, 1> Hex8::shape(const Vector3& xi) noexcept {
  const Eigen::Vector4d n = Quad4::shape({xi[0], xi[1]});
  const double bottom = 0.5 * (1.0 - xi[2]), top = 0.5 * (1.0 + xi[2]);
  Eigen::Matrix<double, 8, 1> result;
  for (int a = 0; a < 4; ++a) {
    result[a] = bottom * n[a];
    result[4 + a] = top * n[a];
  }
  return result;
}

inline Eigen::Matrix<double, 8, 3> Hex8::gradient(const Vector3& xi) noexcept {
  const Eigen::Vector4d n = Quad4::shape({xi[0], xi[1]});
  const Eigen::Matrix<double, 4, 2> d = Quad4::gradient({xi[0], xi[1]});
  const double bottom = 0.5 * (1.0 - xi[2]), top = 0.5 * (1.0 + xi[2]);
  Eigen::Matrix<double, 8, 3> g;
  for (int a = 0; a < 4; ++a) {
    for (int i = 0; i < 2; ++i) {
      g.coeffRef(a, i) = bottom * d.coeff(a, i);
      g.coeffRef(4 + a, i) = top * d.coeff(a, i);
    }
    g.coeffRef(a, 2) = -0.5 * n[a];
    g.coeffRef(4 + a, 2) = 0.5 * n[a];
  }
  return g;
}

}}  // namespace palpate
