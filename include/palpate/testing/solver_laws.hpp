// The laws of LinearSolver (concepts/linear_solver.hpp).
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/violation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Properties that a solver claims beyond its concept.
struct SolverClaims {
  double tolerance = 1e-12;  ///< |b - K x| at most this times |K| |x| + |b|
  bool direct = true;        ///< no iterations, always converges
};

/// The largest of |K t| / |t| over a few vectors: an estimate of |K|_2 within a small factor.
template <palpate::detail::SpdOperator Op>
double norm_estimate(const Op& op) {
  Random random(1929);
  VectorX x(op.size()), y(op.size());
  for (Index i = 0; i < x.size(); ++i) x[i] = random.uniform(-1.0, 1.0);
  double norm = 0.0;
  for (int sweep = 0; sweep < 10; ++sweep) {
    x /= x.norm();
    op.apply(x, y);
    norm = std::max(norm, y.norm());
    x = y;
  }
  return norm;
}

/// The residual |b - K x|, from `apply`.
template <palpate::detail::SpdOperator Op>
double residual(const Op& op, const VectorX& b, const VectorX& x) {
  VectorX r(b.size());
  op.apply(x, r);
  return (b - r).norm();
}

/// "report is truthful": a reported residual equals the measured one, convergence is reported only for a finite
/// solution that satisfies the equations, and a direct solver reports no iterations.
Violations report_laws(const SolveReport& report, double relative_residual, bool is_small, const SolverClaims& claims,
                       const std::string& name);

/// Laws of a prepared solver of the system `op`: "size"; for several loads "solves" (backward error within the claim),
/// "finite", "same answer twice" to the last bit for any previous content of x, "load is left alone", "report is
/// truthful"; "zero load gives zero" exactly; and "symmetric" (f . K^-1 g = g . K^-1 f).
template <palpate::detail::SpdOperator Op, LinearSolver S>
Violations solver_laws(const Op& op, S& solver, SolverClaims claims = {}) {
  Violations v;
  const Index n = op.size();
  expect_true(v, "size", static_cast<Index>(solver.size()) == n);
  if (!v.empty() || n == 0) return v;
  Random random(1910);
  const double norm = norm_estimate(op);
  std::vector<VectorX> loads{VectorX::Unit(n, 0), VectorX::Unit(n, n - 1), VectorX::Constant(n, 1e-12 * norm)};
  for (int i = 0; i < 2; ++i) {
    loads.emplace_back(n);
    for (Index j = 0; j < n; ++j) loads.back()[j] = norm * random.uniform(-1.0, 1.0);
  }
  std::vector<VectorX> answers;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const std::string name = "load " + std::to_string(i);
    const VectorX b = loads[i];
    VectorX x = VectorX::Zero(n), again = VectorX::Constant(n, std::numeric_limits<double>::quiet_NaN());
    const SolveReport report = solver.solve_into(loads[i], x);
    solver.solve_into(loads[i], again);
    expect_true(v, "load is left alone", loads[i] == b, name);
    expect_true(v, "finite", x.allFinite(), name);
    expect_true(v, "same answer twice", x == again, name);
    const double r = residual(op, b, x), bound = claims.tolerance * (norm * x.norm() + b.norm());
    expect_at_most(v, "solves", r, bound, name);
    append(v, report_laws(report, r / b.norm(), r <= bound, claims, name));
    answers.push_back(std::move(x));
  }
  const double one = loads[3].dot(answers[4]), other = loads[4].dot(answers[3]);
  const double sizes = loads[3].norm() * answers[4].norm() + loads[4].norm() * answers[3].norm();
  expect_at_most(v, "symmetric", std::abs(one - other), 1e3 * claims.tolerance * sizes);
  VectorX zero = VectorX::Constant(n, 1.0);
  const SolveReport report = solver.solve_into(VectorX::Zero(n), zero);
  expect_true(v, "zero load gives zero", report.converged && zero.isZero(0.0));
  return v;
}

/// "accurate": the solution for the load K t is t within the relative `bound`, for a few known t. Stronger than a small
/// residual; the bound depends on the condition of K.
template <palpate::detail::SpdOperator Op, LinearSolver S>
Violations accuracy_laws(const Op& op, S& solver, double bound) {
  Violations v;
  Random random(1861);
  VectorX t(op.size()), b(op.size()), x(op.size());
  for (int trial = 0; trial < 3; ++trial) {
    for (Index i = 0; i < t.size(); ++i) t[i] = random.uniform(-1.0, 1.0);
    op.apply(t, b);
    solver.solve_into(b, x);
    expect_at_most(v, "accurate", (x - t).norm(), bound * t.norm(), "trial " + std::to_string(trial));
  }
  return v;
}

inline Violations report_laws(const SolveReport& report, double relative_residual, bool is_small,
                              const SolverClaims& claims, const std::string& name) {
  Violations v;
  const double rounding = 1e-15;
  if (!std::isnan(report.relative_residual))
    expect_at_most(v, "report is truthful", std::abs(report.relative_residual - relative_residual),
                   0.5 * relative_residual + rounding, name + ": stated residual");
  expect_true(v, "report is truthful", !report.converged || is_small,
              name + ": converged, but the residual is not small");
  expect_true(v, "converges", report.converged, name);
  if (claims.direct) expect_true(v, "report is truthful", report.iterations == 0, name + ": iterations");
  return v;
}

}}}  // namespace palpate::testing
