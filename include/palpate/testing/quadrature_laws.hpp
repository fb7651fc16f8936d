// The laws of concepts/quadrature.hpp.
#pragma once

#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/reference_cell.hpp>
#include <palpate/testing/violation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Reference coordinates of a quadrature point as a vector.
template <std::size_t Dim>
Point<static_cast<int>(Dim)> point_of(const std::array<double, Dim>& xi) {
  Point<static_cast<int>(Dim)> x;
  for (std::size_t i = 0; i < Dim; ++i) x[static_cast<Eigen::Index>(i)] = xi[i];
  return x;
}

template <Quadrature Q>
double weight_sum() {
  double sum = 0.0;
  for (const auto& p : Q::points) sum += p.weight;
  return sum;
}

/// Error of a rule on one monomial of the standard domain; the rule's points are given in the cell.
template <Quadrature Q>
double monomial_error(const ReferenceCell<Q::dimension>& cell, const Exponents<Q::dimension>& p) {
  double sum = 0.0;
  for (const auto& q : Q::points) sum += q.weight / cell.scale() * monomial(cell.to_standard(point_of(q.xi)), p);
  return std::abs(sum - monomial_integral(cell.domain, p));
}

/// Laws of a rule on a cell: "finite", "points inside", "weights sum to the volume", "exact to its degree" (every
/// monomial of total degree, on tensor domains of degree per coordinate), "degree is not understated" (some monomial
/// one degree higher is not exact).
template <Quadrature Q>
Violations quadrature_laws(const ReferenceCell<Q::dimension>& cell) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  Violations v;
  double magnitude = 0.0;
  for (const auto& p : Q::points) {
    magnitude += std::abs(p.weight) / cell.scale();
    expect_true(v, "finite", std::isfinite(p.weight) && point_of(p.xi).allFinite());
    expect_at_most(v, "points inside", outside_by<Q::dimension>(cell.domain, cell.to_standard(point_of(p.xi))),
                   8 * epsilon);
  }
  if (violates(v, "finite")) return v;  // bounds are meaningless for NaN
  const double bound = 8 * epsilon * std::max(magnitude, reference_volume(cell.domain));
  expect_at_most(v, "weights sum to the volume", std::abs(weight_sum<Q>() - cell.volume()), bound * cell.scale());

  double beyond = 0.0;
  Worst exactness("exact to its degree", bound);
  for (const auto& p : exponents<Q::dimension>(Q::degree + 1)) {
    const int degree = degree_on(cell.domain, p);
    if (degree > Q::degree + 1) continue;
    const double error = monomial_error<Q>(cell, p);
    if (degree > Q::degree) {
      beyond = std::max(beyond, error);
      continue;
    }
    exactness.observe(error, [&] {
      std::string text = "exponents";
      for (int k : p) text += ' ' + std::to_string(k);
      return text;
    });
  }
  exactness.report(v);
  expect_above(v, "degree is not understated", beyond, bound,
               "exact at degree " + std::to_string(Q::degree + 1) + " too");
  return v;
}

/// The same on a standard domain.
template <Quadrature Q>
Violations quadrature_laws(Domain domain) {
  Violations v;
  expect_true(v, "dimension of the domain", dimension(domain) == Q::dimension);
  if (v.empty()) append(v, quadrature_laws<Q>(ReferenceCell<Q::dimension>{domain}));
  return v;
}

}}}  // namespace palpate::testing
