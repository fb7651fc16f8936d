// The laws of shape functions, the same for solid and surface elements.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/reference_cell.hpp>
#include <palpate/testing/violation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Interior points of an element: its centroid and random convex combinations of its nodes, the same in every run.
template <int Nodes, int Dim>
std::vector<Point<Dim>> sample_points(const Eigen::Matrix<double, Nodes, Dim>& nodes) {
  Random random(20050615);
  std::vector<Point<Dim>> points{nodes.colwise().mean().transpose()};
  for (int k = 0; k < 24; ++k) {
    // Cubes of uniform numbers as weights spread the points; plain uniform weights would cluster them at the centroid.
    const Eigen::Matrix<double, Nodes, 1> w = random.vector<Nodes>(0.01, 1.0).array().cube();
    points.push_back(nodes.transpose() * w / w.sum());
  }
  return points;
}

/// Derivatives of the shape functions by a five-point stencil, exact to degree 4 except for rounding.
template <class S, int Dim>
Eigen::Matrix<double, S::nodes, Dim> numerical_gradient(const Point<Dim>& xi) {
  constexpr double h = 1.0 / 256.0;
  Eigen::Matrix<double, S::nodes, Dim> g;
  for (int i = 0; i < Dim; ++i) {
    const Point<Dim> e = h * Point<Dim>::Unit(i);
    g.col(i) =
        (8.0 * (S::shape(xi + e) - S::shape(xi - e)) - (S::shape(xi + 2.0 * e) - S::shape(xi - 2.0 * e))) / (12.0 * h);
  }
  return g;
}

/// Largest error at the sample points of interpolating a monomial from its nodal values.
template <class S, int Dim>
double interpolation_error(const std::vector<Point<Dim>>& points, const Exponents<Dim>& p) {
  const Eigen::Matrix<double, S::nodes, Dim> x = S::reference_nodes();
  Eigen::Matrix<double, S::nodes, 1> values;
  for (int a = 0; a < S::nodes; ++a) values[a] = monomial(Point<Dim>(x.row(a).transpose()), p);
  double worst = 0.0;
  for (const auto& xi : points) {
    const double error = std::abs(values.dot(S::shape(xi)) - monomial(xi, p));
    if (!(error <= worst)) worst = error;
    if (std::isnan(worst)) break;
  }
  return worst;
}

/// "Kronecker delta" at the nodes; "partition of unity", "zero-sum gradients", "gradient is the derivative" at sample
/// points.
template <class S, int Dim>
Violations basic_shape_laws() {
  constexpr double bound = 1e-13;
  const Eigen::Matrix<double, S::nodes, Dim> x = S::reference_nodes();
  const auto name = [](int a) { return "node " + std::to_string(a); };
  Worst delta("Kronecker delta", bound), unity("partition of unity", bound), zero_sum("zero-sum gradients", 16 * bound);
  Worst derivative("gradient is the derivative", 1e-10);
  for (int b = 0; b < S::nodes; ++b) {
    const Eigen::Matrix<double, S::nodes, 1> n = S::shape(Point<Dim>(x.row(b).transpose()));
    for (int a = 0; a < S::nodes; ++a)
      delta.observe(std::abs(n[a] - (a == b ? 1.0 : 0.0)),
                    [&] { return "function " + std::to_string(a) + " at " + name(b); });
  }
  int k = 0;
  for (const auto& xi : sample_points<S::nodes, Dim>(x)) {
    const auto here = [&k] { return "sample point " + std::to_string(k); };
    const Eigen::Matrix<double, S::nodes, Dim> g = S::gradient(xi), numerical = numerical_gradient<S, Dim>(xi);
    unity.observe(std::abs(S::shape(xi).sum() - 1.0), here);
    for (int i = 0; i < Dim; ++i) zero_sum.observe(std::abs(g.col(i).sum()), here);
    for (int a = 0; a < S::nodes; ++a)
      for (int i = 0; i < Dim; ++i)
        derivative.observe(std::abs(g(a, i) - numerical(a, i)), [&] { return name(a) + ", " + here(); });
    ++k;
  }
  Violations v;
  for (const Worst* law : {&delta, &unity, &zero_sum, &derivative}) law->report(v);
  return v;
}

/// "linear completeness" (1, x, y, z), "polynomial completeness" (all monomials up to total degree `order`), "order is
/// not understated" (some monomial one degree higher is not reproduced).
template <class S, int Dim>
Violations completeness_laws(int order) {
  constexpr double bound = 1e-12;
  const auto points = sample_points<S::nodes, Dim>(S::reference_nodes());
  Worst linear("linear completeness", bound), polynomial("polynomial completeness", bound);
  double beyond = 0.0;
  for (const auto& p : exponents<Dim>(order + 1)) {
    const int degree = total_degree(p);
    if (degree > order + 1) continue;
    const double error = interpolation_error<S, Dim>(points, p);
    const auto name = [degree] { return "a monomial of degree " + std::to_string(degree); };
    if (degree <= 1) linear.observe(error, name);
    if (degree <= order) polynomial.observe(error, name);
    if (degree == order + 1) beyond = std::max(beyond, error);
  }
  Violations v;
  linear.report(v);
  polynomial.report(v);
  expect_above(v, "order is not understated", beyond, bound,
               "degree " + std::to_string(order + 1) + " is reproduced too");
  return v;
}

}}}  // namespace palpate::testing
