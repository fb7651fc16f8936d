// The quadratic serendipity functions of squares and cubes, shared by Quad8 and Hex20.
#pragma once

#include <palpate/core/config.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace serendipity {

template <int Nodes, int Dimension>
using Table = Eigen::Matrix<double, Nodes, Dimension>;

/// Factor of a shape function along one axis for a node at s (-1, 0 or 1): (1 + s x) / 2, or 1 - x^2 in the middle.
double factor(double s, double x) noexcept;
double factor_derivative(double s, double x) noexcept;

/// Functions of nodes at `s` (rows of -1, 0, 1; at most one 0): the product of factors, at corners times
/// (sum s_i x_i - (Dimension - 1)) (Zienkiewicz and Taylor, The Finite Element Method, serendipity family).
template <int Nodes, int Dimension>
Table<Nodes, 1> shape(const Table<Nodes, Dimension>& s, const Table<Dimension, 1>& xi) noexcept {
  Table<Nodes, 1> n;
  for (int a = 0; a < Nodes; ++a) {
    double product = 1.0;
    for (int i = 0; i < Dimension; ++i) product *= factor(s(a, i), xi[i]);
    const bool corner = (s.row(a).array() != 0.0).all();
    n[a] = corner ? product * (s.row(a).dot(xi) - (Dimension - 1)) : product;
  }
  return n;
}

/// Their derivatives by the reference coordinates.
template <int Nodes, int Dimension>
Table<Nodes, Dimension> gradient(const Table<Nodes, Dimension>& s, const Table<Dimension, 1>& xi) noexcept {
  Table<Nodes, Dimension> g;
  for (int a = 0; a < Nodes; ++a) {
    const bool corner = (s.row(a).array() != 0.0).all();
    const double sum = corner ? s.row(a).dot(xi) - (Dimension - 1) : 1.0;
    for (int j = 0; j < Dimension; ++j) {
      double others = 1.0;
      for (int i = 0; i < Dimension; ++i)
        if (i != j) others *= factor(s(a, i), xi[i]);
      g(a, j) = others * factor_derivative(s(a, j), xi[j]) * sum;
      if (corner) g(a, j) += others * factor(s(a, j), xi[j]) * s(a, j);
    }
  }
  return g;
}

/// Corners, then the middles of `edges`.
template <int Nodes, int Dimension, std::size_t Edges>
Table<Nodes, Dimension> with_middles(const Table<Nodes - static_cast<int>(Edges), Dimension>& corners,
                                     const std::array<std::array<int, 2>, Edges>& edges) noexcept {
  Table<Nodes, Dimension> x;
  x.template topRows<Nodes - static_cast<int>(Edges)>() = corners;
  for (std::size_t e = 0; e < Edges; ++e)
    x.row(Nodes - static_cast<int>(Edges - e)) = 0.5 * (corners.row(edges[e][0]) + corners.row(edges[e][1]));
  return x;
}

}}}  // namespace palpate::serendipity

#if PALPATE_HEADER_ONLY
#include <palpate/element/serendipity.ipp>
#endif
