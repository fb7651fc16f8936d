// Reference domains: their volumes, exact integrals of monomials, and an exact integration as reference for rules.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// [-1,1], the unit triangle and tetrahedron (0, e1, e2, e3), [-1,1]^2 and [-1,1]^3.
enum class Domain { interval, triangle, tetrahedron, quadrilateral, hexahedron };

constexpr bool is_simplex(Domain d) {
  return d == Domain::triangle || d == Domain::tetrahedron;
}
constexpr int dimension(Domain d) {
  return d == Domain::interval ? 1 : d == Domain::triangle || d == Domain::quadrilateral ? 2 : 3;
}
constexpr double reference_volume(Domain d) {
  switch (d) {
    case Domain::interval:
      return 2.0;
    case Domain::triangle:
      return 1.0 / 2.0;
    case Domain::tetrahedron:
      return 1.0 / 6.0;
    case Domain::quadrilateral:
      return 4.0;
    case Domain::hexahedron:
      break;
  }
  return 8.0;
}

template <int Dim>
using Point = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Exponents = std::array<int, static_cast<std::size_t>(Dim)>;

template <std::size_t Dim>
int total_degree(const std::array<int, Dim>& p) {
  int sum = 0;
  for (int k : p) sum += k;
  return sum;
}

/// The degree of a monomial that is relevant on a domain: the total one on simplices, the largest per coordinate on
/// tensor domains.
template <std::size_t Dim>
int degree_on(Domain domain, const std::array<int, Dim>& p) {
  return is_simplex(domain) ? total_degree(p) : *std::ranges::max_element(p);
}

/// All exponents with no entry above `largest`.
template <int Dim>
std::vector<Exponents<Dim>> exponents(int largest) {
  std::vector<Exponents<Dim>> all;
  Exponents<Dim> p{};
  while (true) {
    all.push_back(p);
    std::size_t i = 0;
    while (i < p.size() && p[i] == largest) p[i++] = 0;
    if (i == p.size()) return all;
    ++p[i];
  }
}

/// x^p0 y^p1 z^p2.
template <std::size_t Dim, class V>
double monomial(const V& x, const std::array<int, Dim>& p) {
  double value = 1.0;
  for (std::size_t i = 0; i < Dim; ++i)
    for (int k = 0; k < p[i]; ++k) value *= x[static_cast<Eigen::Index>(i)];
  return value;
}

/// Integral of a monomial over a domain: p! q! r! / (p + q + r + Dim)! on simplices, a product of 2/(p+1) or 0 on
/// tensor domains.
template <std::size_t Dim>
double monomial_integral(Domain domain, const std::array<int, Dim>& p) {
  double value = 1.0;
  if (!is_simplex(domain)) {
    for (int k : p) value *= k % 2 == 1 ? 0.0 : 2.0 / (k + 1);
    return value;
  }
  int n = 0;
  for (int k : p)
    for (int j = 1; j <= k; ++j) value *= static_cast<double>(j) / ++n;
  for (std::size_t i = 0; i < Dim; ++i) value /= ++n;
  return value;
}

/// A reference domain moved by an affine map: x = origin + axes * standard. Elements may choose their reference domain
/// freely.
template <int Dim>
struct ReferenceCell {
  Domain domain;
  Point<Dim> origin = Point<Dim>::Zero();
  Eigen::Matrix<double, Dim, Dim> axes = Eigen::Matrix<double, Dim, Dim>::Identity();

  Point<Dim> to_cell(const Point<Dim>& standard) const { return origin + axes * standard; }
  Point<Dim> to_standard(const Point<Dim>& x) const { return axes.inverse() * (x - origin); }
  double scale() const { return std::abs(axes.determinant()); }
  double volume() const { return reference_volume(domain) * scale(); }
};

/// Distance of a point outside of the standard domain; zero or negative inside.
template <int Dim>
double outside_by(Domain domain, const Point<Dim>& x) {
  if (!is_simplex(domain)) return x.cwiseAbs().maxCoeff() - 1.0;
  return std::max(-x.minCoeff(), x.sum() - 1.0);
}

/// Integral over a cell by five Gauss points per direction, collapsed on simplices: exact to degree 9 per coordinate on
/// tensor domains, to total degree 7 on simplices. Independent of the library's rules for triangles and tetrahedra.
template <int Dim, class F>
double integrate(const ReferenceCell<Dim>& cell, F f) {
  const auto& line = GaussLegendre<5>::points;
  double sum = 0.0;
  for (const auto& which : exponents<Dim>(static_cast<int>(line.size()) - 1)) {
    Point<Dim> x;
    double weight = cell.scale(), left = 1.0;
    for (int i = 0; i < Dim; ++i) {
      const auto& p = line[static_cast<std::size_t>(which[static_cast<std::size_t>(i)])];
      weight *= p.weight;
      x[i] = p.xi[0];
      if (!is_simplex(cell.domain)) continue;
      const double s = 0.5 * (1.0 + p.xi[0]);
      x[i] = s * left;
      weight *= 0.5 * left;
      left *= 1.0 - s;
    }
    sum += weight * f(cell.to_cell(x));
  }
  return sum;
}

}}}  // namespace palpate::testing
