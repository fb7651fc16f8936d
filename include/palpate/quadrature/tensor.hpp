// Gauss-Legendre rules on the square [-1, 1]^2 and the cube [-1, 1]^3.
#pragma once

#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// N points per axis, the first coordinate running fastest; exact to degree 2 N - 1 in every coordinate.
template <int N, int Dimension>
struct TensorRule {
  static constexpr int dimension = Dimension, degree = 2 * N - 1;
  static constexpr std::size_t count = Dimension == 2 ? N * N : N * N * N;
  static constexpr std::array<QuadraturePoint<Dimension>, count> points = [] {
    std::array<QuadraturePoint<Dimension>, count> all{};
    for (std::size_t k = 0; k < count; ++k) {
      all[k].weight = 1.0;
      std::size_t rest = k;
      for (double& xi : all[k].xi) {
        const auto& on_line = GaussLegendre<N>::points[rest % N];
        xi = on_line.xi[0];
        all[k].weight *= on_line.weight;
        rest /= N;
      }
    }
    return all;
  }();
};

/// Rule on the square with N x N points.
template <int N>
using QuadrilateralRule = TensorRule<N, 2>;
/// Rule on the cube with N x N x N points.
template <int N>
using HexahedronRule = TensorRule<N, 3>;

}}  // namespace palpate
