// The quadratic serendipity functions of squares and cubes, shared by Quad8 and Hex20.
#pragma once

#include <palpate/core/config.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace serendipity {

template <int Nodes, int Dimension>
using Table = Eigen::Matrix<double, Nodes, Dimension>;

/// Factor of a shape function along one axis for a node at s (-1, 0 or 1): (1 + s x) / 2 for s = -1 or 1, 1 - x^2 for s
/// = 0.
double factor(double s, double x) noexcept;
double factor_derivative(double s, double x) noexcept;

/// True if node a is a corner: no coordinate is 0.
template <int Nodes, int Dimension>
bool is_corner(const Table<Nodes, Dimension>& s, int a) noexcept {
  for (int i = 0; i < Dimension; ++i)
    if (s.coeff(a, i) == 0.0) return false;
  return true;
}

/// Additional factor of a corner a: sum s_i x_i - (Dimension - 1).
template <int Nodes, int Dimension>
double corner_factor(const Table<Nodes, Dimension>& s, int a, const Table<Dimension, 1>& xi) noexcept {
  double sum = 0.0;
  for (int i = 0; i < Dimension; ++i) sum += s.coeff(a, i) * xi[i];
  return sum - (Dimension - 1);
}

/// Shape functions of nodes at `s` (rows of -1, 0, 1; at most one 0): the product of the factors, for corners times
/// (sum s_i x_i - (Dimension - 1)) (Zienkiewicz and Taylor, The Finite Element Method, serendipity family).
template <int Nodes, int Dimension>
Table<Nodes, 1> shape(const Table<Nodes, Dimension>& s, const Table<Dimension, 1>& xi) noexcept {
  Table<Nodes, 1> n;
  for (int a = 0; a < Nodes; ++a) {
    double product = 1.0;
    for (int i = 0; i < Dimension; ++i) product *= factor(s.coeff(a, i), xi[i]);
    n[a] = is_corner(s, a) ? product * corner_factor(s, a, xi) : product;
  }
  return n;
}

/// Their derivatives with respect to the reference coordinates.
template <int Nodes, int Dimension>
Table<Nodes, Dimension> gradient(const Table<Nodes, Dimension>& s, const Table<Dimension, 1>& xi) noexcept {
  Table<Nodes, Dimension> g;
  for (int a = 0; a < Nodes; ++a) {
    const bool corner = is_corner(s, a);
    const double sum = corner ? corner_factor(s, a, xi) : 1.0;
    for (int j = 0; j < Dimension; ++j) {
      double others = 1.0;
      for (int i = 0; i < Dimension; ++i)
        if (i != j) others *= factor(s.coeff(a, i), xi[i]);
      const double along = s.coeff(a, j);
      g.coeffRef(a, j) = others * factor_derivative(along, xi[j]) * sum;
      if (corner) g.coeffRef(a, j) += others * factor(along, xi[j]) * along;
    }
  }
  return g;
}

/// The corners, followed by the midpoints of `edges`.
template <int Nodes, int Dimension, std::size_t Edges>
Table<Nodes, Dimension> with_middles(const Table<Nodes - static_cast<int>(Edges), Dimension>& corners,
                                     const std::array<std::array<int, 2>, Edges>& edges) noexcept {
  constexpr int corner_count = Nodes - static_cast<int>(Edges);
  Table<Nodes, Dimension> x;
  for (int i = 0; i < Dimension; ++i) {
    for (int a = 0; a < corner_count; ++a) x.coeffRef(a, i) = corners.coeff(a, i);
    for (int e = 0; e < static_cast<int>(Edges); ++e) {
      const auto [a, b] = edges[static_cast<std::size_t>(e)];
      x.coeffRef(corner_count + e, i) = 0.5 * (corners.coeff(a, i) + corners.coeff(b, i));
    }
  }
  return x;
}

inline double factor(double s, double x) noexcept {
  return s == 0.0 ? 1.0 - x * x : 0.5 * (1.0 + s * x);
}

inline double factor_derivative(double s, double x) noexcept {
  return s == 0.0 ? -2.0 * x : 0.5 * s;
}

}}}  // namespace palpate::serendipity
