#pragma once

#include <numbers>
#include <palpate/element/tet4.hpp>
#include <palpate/quadrature/simplex.hpp>

/// The thesis' regular reference tetrahedron as a user-defined element: corrected, and as printed.
namespace thesis {

inline constexpr double sqrt2 = std::numbers::sqrt2, sqrt3 = std::numbers::sqrt3, sqrt6 = 2.4494897427831780982;

/// A rule of the unit tetrahedron mapped to the regular one: edge sqrt 3, centroid 0, volume sqrt 6 / 4.
template <class Unit>
struct Regular {
  static constexpr int dimension = 3, degree = Unit::degree;
  static constexpr auto points = [] {
    auto all = Unit::points;
    for (auto& q : all) {
      const auto [a, b, c] = q.xi;  // weights of nodes 2, 3 and 4; node 1 has the remainder
      q.xi = {1.0 - 1.5 * (a + b) - c, 0.5 * sqrt3 * (a - b), sqrt2 * (c - 0.25)};
      q.weight *= 6.0 * sqrt6 / 4.0;
    }
    return all;
  }();
};

/// Thesis 3.3.2, corrected: N1 = (3 + 8u - 2 sqrt2 w)/12 (printed with + in front of w), its derivatives (2/3, 0,
/// -sqrt2/6) (printed with the opposite signs), volume sqrt6/4 (printed: weight 8), and the second and third node
/// exchanged, so that the numbering is right-handed.
struct ThesisTet4 {
  static constexpr int nodes = 4;
  static constexpr int order = 1;
  static constexpr double reference_volume = sqrt6 / 4.0;
  static constexpr std::array<std::array<int, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  using Face = palpate::Tri3;
  using Quadrature = Regular<palpate::TetrahedronRule<1>>;
  using MassQuadrature = Regular<palpate::TetrahedronRule<2>>;

  static Eigen::Vector4d shape(const palpate::Vector3& xi) noexcept {
    const double u = xi[0], v = xi[1], w = xi[2];
    return {(3 + 8 * u - 2 * sqrt2 * w) / 12, (3 - 4 * u + 4 * sqrt3 * v - 2 * sqrt2 * w) / 12,
            (3 - 4 * u - 4 * sqrt3 * v - 2 * sqrt2 * w) / 12, (1 + 2 * sqrt2 * w) / 4};
  }
  static Eigen::Matrix<double, 4, 3> gradient(const palpate::Vector3&) noexcept {
    Eigen::Matrix<double, 4, 3> g;
    g << 2.0 / 3, 0, -sqrt2 / 6,           //
        -1.0 / 3, sqrt3 / 3, -sqrt2 / 6,   //
        -1.0 / 3, -sqrt3 / 3, -sqrt2 / 6,  //
        0, 0, sqrt2 / 2;
    return g;
  }
  static Eigen::Matrix<double, 4, 3> reference_nodes() noexcept {
    Eigen::Matrix<double, 4, 3> x;
    x << 1, 0, -sqrt2 / 4,             //
        -0.5, sqrt3 / 2, -sqrt2 / 4,   //
        -0.5, -sqrt3 / 2, -sqrt2 / 4,  //
        0, 0, 3 * sqrt2 / 4;
    return x;
  }
};

/// N1 as printed, with its exact derivative.
struct PrintedFunction : ThesisTet4 {
  static Eigen::Vector4d shape(const palpate::Vector3& xi) noexcept {
    Eigen::Vector4d n = ThesisTet4::shape(xi);
    n[0] = (3 + 8 * xi[0] + 2 * sqrt2 * xi[2]) / 12;
    return n;
  }
  static Eigen::Matrix<double, 4, 3> gradient(const palpate::Vector3& xi) noexcept {
    Eigen::Matrix<double, 4, 3> g = ThesisTet4::gradient(xi);
    g(0, 2) = sqrt2 / 6;
    return g;
  }
};

/// The correct functions with the printed table of derivatives: the first row has the wrong sign.
struct PrintedDerivatives : ThesisTet4 {
  static Eigen::Matrix<double, 4, 3> gradient(const palpate::Vector3& xi) noexcept {
    Eigen::Matrix<double, 4, 3> g = ThesisTet4::gradient(xi);
    g.row(0) *= -1.0;
    return g;
  }
};

/// The printed one-point rule: 2 per axis, which is the volume of a cube.
struct PrintedRule {
  static constexpr int dimension = 3, degree = 1;
  static constexpr std::array<palpate::QuadraturePoint<3>, 1> points{{{{0.0, 0.0, 0.0}, 8.0}}};
};
struct PrintedWeight : ThesisTet4 {
  using Quadrature = PrintedRule;
};

/// Nodes in the printed order with outward faces: a negative volume in the numbering of all mesh generators.
struct PrintedOrder : ThesisTet4 {
  static constexpr std::array<std::array<int, 3>, 4> faces{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}}};
  static Eigen::Vector4d shape(const palpate::Vector3& xi) noexcept { return swap() * ThesisTet4::shape(xi); }
  static Eigen::Matrix<double, 4, 3> gradient(const palpate::Vector3& xi) noexcept {
    return swap() * ThesisTet4::gradient(xi);
  }
  static Eigen::Matrix<double, 4, 3> reference_nodes() noexcept { return swap() * ThesisTet4::reference_nodes(); }

 private:
  static Eigen::Matrix4d swap() {
    Eigen::Matrix4d p;
    p << 1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
    return p;
  }
};

}  // namespace thesis
