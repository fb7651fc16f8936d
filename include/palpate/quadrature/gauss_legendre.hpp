// Gauss-Legendre rules with 1 to 5 points on [-1, 1] (thesis 3.5 and appendix B, in full double precision), and their
// tensor products on the square [-1, 1]^2 and the cube [-1, 1]^3.
#pragma once

#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// N-point rule on [-1, 1], exact to degree 2N - 1. Abscissae and weights: roots of the Legendre polynomial, e.g.
/// Abramowitz and Stegun, table 25.4.
template <int N>
struct GaussLegendre;

template <>
struct GaussLegendre<1> {
  static constexpr int dimension = 1, degree = 1;
  static constexpr std::array<QuadraturePoint<1>, 1> points{{{{0.0}, 2.0}}};
};

template <>
struct GaussLegendre<2> {
  static constexpr int dimension = 1, degree = 3;
  static constexpr std::array<QuadraturePoint<1>, 2> points{
      {{{-0.57735026918962576451}, 1.0}, {{0.57735026918962576451}, 1.0}}};
};

template <>
struct GaussLegendre<3> {
  static constexpr int dimension = 1, degree = 5;
  static constexpr std::array<QuadraturePoint<1>, 3> points{
      {{{-0.77459666924148337704}, 5.0 / 9.0}, {{0.0}, 8.0 / 9.0}, {{0.77459666924148337704}, 5.0 / 9.0}}};
};

template <>
struct GaussLegendre<4> {
  static constexpr int dimension = 1, degree = 7;
  static constexpr std::array<QuadraturePoint<1>, 4> points{{{{-0.86113631159405257522}, 0.34785484513745385737},
                                                             {{-0.33998104358485626480}, 0.65214515486254614263},
                                                             {{0.33998104358485626480}, 0.65214515486254614263},
                                                             {{0.86113631159405257522}, 0.34785484513745385737}}};
};

template <>
struct GaussLegendre<5> {
  static constexpr int dimension = 1, degree = 9;
  static constexpr std::array<QuadraturePoint<1>, 5> points{{{{-0.90617984593866399280}, 0.23692688505618908751},
                                                             {{-0.53846931010568309104}, 0.47862867049936646804},
                                                             {{0.0}, 128.0 / 225.0},
                                                             {{0.53846931010568309104}, 0.47862867049936646804},
                                                             {{0.90617984593866399280}, 0.23692688505618908751}}};
};

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
