#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/quadrature/simplex.hpp>

/// User-defined elements: the law suites must also work for elements outside the library.
namespace user {

using palpate::Vector2;
using palpate::Vector3;

template <int Nodes, int Dim>
using Table = Eigen::Matrix<double, Nodes, Dim>;

/// N x N x ... Gauss points on [-1, 1]^Dim.
template <int N, int Dim>
struct TensorRule {
  static constexpr int dimension = Dim, degree = 2 * N - 1;
  static constexpr std::size_t count = Dim == 2 ? N * N : N * N * N;
  static constexpr auto points = [] {
    std::array<palpate::QuadraturePoint<Dim>, count> all{};
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t rest = k;
      all[k].weight = 1.0;
      for (std::size_t i = 0; i < Dim; ++i, rest /= N) {
        const auto& p = palpate::GaussLegendre<N>::points[rest % N];
        all[k].xi[i] = p.xi[0];
        all[k].weight *= p.weight;
      }
    }
    return all;
  }();
};

/// Product of (1 + x_i x)/2 per coordinate: the (multi)linear functions of a box with corners x_i.
template <class S, int Dim>
struct Multilinear {
  static constexpr int nodes = 1 << Dim;
  static Table<nodes, 1> shape(const Eigen::Matrix<double, Dim, 1>& xi) noexcept {
    return factors(xi).rowwise().prod();
  }
  static Table<nodes, Dim> gradient(const Eigen::Matrix<double, Dim, 1>& xi) noexcept {
    Table<nodes, Dim> g;
    for (int i = 0; i < Dim; ++i) {
      Table<nodes, Dim> f = factors(xi);
      f.col(i) = 0.5 * S::reference_nodes().col(i);
      g.col(i) = f.rowwise().prod();
    }
    return g;
  }

 private:
  static Table<nodes, Dim> factors(const Eigen::Matrix<double, Dim, 1>& xi) {
    const Table<nodes, Dim> x = S::reference_nodes();
    return 0.5 * (1.0 + (x * xi.asDiagonal()).array());
  }
};

struct Quad4 : Multilinear<Quad4, 2> {
  using Quadrature = TensorRule<2, 2>;
  static Table<4, 2> reference_nodes() noexcept {
    Table<4, 2> x;
    x << -1, -1, 1, -1, 1, 1, -1, 1;
    return x;
  }
};

struct Hex8 : Multilinear<Hex8, 3> {
  static constexpr int order = 1;
  static constexpr double reference_volume = 8.0;
  static constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 4, 7, 3}, {1, 2, 6, 5}}};
  using Face = Quad4;
  using Quadrature = TensorRule<2, 3>;
  using MassQuadrature = TensorRule<2, 3>;
  static Table<8, 3> reference_nodes() noexcept {
    Table<8, 3> x;
    x << -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1;
    return x;
  }
};

/// Quadratic simplex in barycentric coordinates L: corners L (2 L - 1), then 4 L_i L_j on the edges listed by S.
template <class S, int Dim>
struct QuadraticSimplex {
  static constexpr int corners = Dim + 1, nodes = corners * (corners + 1) / 2;
  static constexpr int order = 2;
  using Barycentric = Eigen::Matrix<double, corners, 1>;

  static Table<nodes, 1> shape(const Eigen::Matrix<double, Dim, 1>& xi) noexcept {
    const Barycentric l = barycentric(xi);
    Table<nodes, 1> n;
    for (int a = 0; a < corners; ++a) n[a] = l[a] * (2 * l[a] - 1);
    for (int a = corners; a < nodes; ++a) n[a] = 4 * l[edge(a)[0]] * l[edge(a)[1]];
    return n;
  }
  static Table<nodes, Dim> gradient(const Eigen::Matrix<double, Dim, 1>& xi) noexcept {
    const Barycentric l = barycentric(xi);
    Table<corners, Dim> d;
    d << Eigen::Matrix<double, 1, Dim>::Constant(-1.0), Eigen::Matrix<double, Dim, Dim>::Identity();
    Table<nodes, Dim> g;
    for (int a = 0; a < corners; ++a) g.row(a) = (4 * l[a] - 1) * d.row(a);
    for (int a = corners; a < nodes; ++a)
      g.row(a) = 4 * (l[edge(a)[0]] * d.row(edge(a)[1]) + l[edge(a)[1]] * d.row(edge(a)[0]));
    return g;
  }
  static Table<nodes, Dim> reference_nodes() noexcept {
    Table<nodes, Dim> x = Table<nodes, Dim>::Zero();
    for (int a = 1; a < corners; ++a) x(a, a - 1) = 1.0;
    for (int a = corners; a < nodes; ++a) x.row(a) = 0.5 * (x.row(edge(a)[0]) + x.row(edge(a)[1]));
    return x;
  }

 private:
  static Barycentric barycentric(const Eigen::Matrix<double, Dim, 1>& xi) {
    Barycentric l;
    l << 1.0 - xi.sum(), xi;
    return l;
  }
  static const std::array<int, 2>& edge(int a) { return S::edges[static_cast<std::size_t>(a - corners)]; }
};

struct Tri6 : QuadraticSimplex<Tri6, 2> {
  static constexpr std::array<std::array<int, 2>, 3> edges{{{0, 1}, {1, 2}, {2, 0}}};
  using Quadrature = palpate::TriangleRule<4>;
};

struct Tet10 : QuadraticSimplex<Tet10, 3> {
  static constexpr double reference_volume = 1.0 / 6.0;
  static constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  static constexpr std::array<std::array<int, 6>, 4> faces{
      {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}}};
  using Face = Tri6;
  using Quadrature = palpate::TetrahedronRule<2>;
  using MassQuadrature = palpate::TetrahedronRule<5>;
};

}  // namespace user
