// A user-defined element: a hexahedron with more nodes along x, the direction of largest variation (thesis, figure
// 3.2).
#pragma once

#include <palpate/element/hex8.hpp>

/// An element consists of nodes, shape functions and their gradients, faces and quadrature rules. It is not registered
/// anywhere. `static_assert(palpate::Element<Hex12>)` below checks the form at compile time, the laws of
/// palpate/testing/element_laws.hpp check the numbers (main.cpp runs them).
namespace own {

/// The side of Hex12: quadratic along its first axis. Nodes: the corners of Quad4, then the middles of the two long
/// edges.
struct Quad6 {
  static constexpr int nodes = 6;
  /// Triangles for contact; together they use every node.
  static constexpr std::array<std::array<int, 3>, 4> triangles{{{0, 4, 5}, {0, 5, 3}, {4, 1, 2}, {4, 2, 5}}};
  using Quadrature = palpate::QuadrilateralRule<3>;

  static Eigen::Matrix<double, 6, 2> reference_nodes() noexcept {
    Eigen::Matrix<double, 6, 2> x;
    x << -1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 0, 1;
    return x;
  }
  static Eigen::Matrix<double, 6, 1> shape(const Eigen::Vector2d& xi) noexcept {
    const Eigen::Matrix<double, 6, 2> x = reference_nodes();
    Eigen::Matrix<double, 6, 1> n;
    for (int a = 0; a < 6; ++a) n[a] = along(x(a, 0), xi[0]) * 0.5 * (1 + x(a, 1) * xi[1]);
    return n;
  }
  static Eigen::Matrix<double, 6, 2> gradient(const Eigen::Vector2d& xi) noexcept {
    const Eigen::Matrix<double, 6, 2> x = reference_nodes();
    Eigen::Matrix<double, 6, 2> g;
    for (int a = 0; a < 6; ++a)
      g.row(a) << slope(x(a, 0), xi[0]) * 0.5 * (1 + x(a, 1) * xi[1]), along(x(a, 0), xi[0]) * 0.5 * x(a, 1);
    return g;
  }

  /// Quadratic function of u that is 1 at its node (-1, 0 or 1) and 0 at the other two, and its derivative.
  static double along(double node, double u) noexcept { return node == 0.0 ? 1 - u * u : 0.5 * u * (u + node); }
  static double slope(double node, double u) noexcept { return node == 0.0 ? -2 * u : u + 0.5 * node; }
};

/// 3 x 2 x 2 Gauss points.
struct LongRule {
  static constexpr int dimension = 3, degree = 3;
  static constexpr std::array<palpate::QuadraturePoint<3>, 12> points = [] {
    std::array<palpate::QuadraturePoint<3>, 12> all{};
    std::size_t k = 0;
    for (const auto& u : palpate::GaussLegendre<3>::points)
      for (const auto& v : palpate::GaussLegendre<2>::points)
        for (const auto& w : palpate::GaussLegendre<2>::points)
          all[k++] = {{u.xi[0], v.xi[0], w.xi[0]}, u.weight * v.weight * w.weight};
    return all;
  }();
};

/// Quadratic along x, linear along y and z. Nodes: the corners of Hex8, then the middles of the edges along x.
struct Hex12 {
  static constexpr int nodes = 12;
  static constexpr int order = 1;  // complete to this degree; along x one higher
  static constexpr double reference_volume = 8.0;
  /// Outward, their first edge along x; the two ends have four nodes only.
  static constexpr std::array<std::array<int, 6>, 6> faces{{{3, 2, 1, 0, 9, 8},
                                                            {4, 5, 6, 7, 10, 11},
                                                            {0, 1, 5, 4, 8, 10},
                                                            {2, 3, 7, 6, 9, 11},
                                                            {0, 4, 7, 3, -1, -1},
                                                            {1, 2, 6, 5, -1, -1}}};
  using Face = Quad6;
  using SmallFace = palpate::Quad4;
  using Quadrature = LongRule;
  using MassQuadrature = LongRule;

  static Eigen::Matrix<double, 12, 3> reference_nodes() noexcept {
    Eigen::Matrix<double, 12, 3> x;
    x << -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1,  //
        0, -1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1;
    return x;
  }
  static Eigen::Matrix<double, 12, 1> shape(const palpate::Vector3& xi) noexcept {
    const Eigen::Matrix<double, 12, 3> x = reference_nodes();
    Eigen::Matrix<double, 12, 1> n;
    for (int a = 0; a < 12; ++a)
      n[a] = Quad6::along(x(a, 0), xi[0]) * 0.25 * (1 + x(a, 1) * xi[1]) * (1 + x(a, 2) * xi[2]);
    return n;
  }
  static Eigen::Matrix<double, 12, 3> gradient(const palpate::Vector3& xi) noexcept {
    const Eigen::Matrix<double, 12, 3> x = reference_nodes();
    Eigen::Matrix<double, 12, 3> g;
    for (int a = 0; a < 12; ++a) {
      const double u = Quad6::along(x(a, 0), xi[0]), v = 0.5 * (1 + x(a, 1) * xi[1]), w = 0.5 * (1 + x(a, 2) * xi[2]);
      g.row(a) << Quad6::slope(x(a, 0), xi[0]) * v * w, u * 0.5 * x(a, 1) * w, u * v * 0.5 * x(a, 2);
    }
    return g;
  }
};

static_assert(palpate::Element<Hex12> && palpate::HasSmallFace<Hex12>);

}  // namespace own
