// How much a solver can be trusted: condition estimate and probe solve.
#pragma once

#include <palpate/concepts/linear_solver.hpp>

#include <cmath>
#include <random>

namespace palpate { inline namespace PALPATE_ABI {

/// Estimate of |K^-1|_1 for symmetric K from a handful of solves (Hager 1984, Higham 1988; usually within a factor 3,
/// always a lower bound). Allocates; NaN when a solve is not finite.
template <LinearSolver S>
double inverse_norm_estimate(S& solver) {
  const Index n = solver.size();
  if (n == 0) return 0.0;
  VectorX x = VectorX::Constant(n, 1.0 / static_cast<double>(n)), y(n), z(n);
  double estimate = 0.0;
  for (int sweep = 0; sweep < 5; ++sweep) {
    solver.solve_into(x, y);
    const double norm = y.lpNorm<1>();
    if (!std::isfinite(norm)) return norm;
    if (sweep > 0 && norm <= estimate) break;
    estimate = norm;
    x = y.unaryExpr([](double v) { return v >= 0.0 ? 1.0 : -1.0; });
    solver.solve_into(x, z);
    Index largest = 0;
    if (z.cwiseAbs().maxCoeff(&largest) <= std::abs(z.dot(x)) / static_cast<double>(n) && sweep > 0) break;
    x.setZero();
    x[largest] = 1.0;
  }
  return estimate;
}

/// Solves K x = K t for a fixed random t and returns |x - t| / |t|: the accuracy left, measured, whatever residuals
/// say. Infinity when the answer is not finite. Allocates.
template <SpdOperator Op, LinearSolver S>
double probe_error(const Op& op, S& solver) {
  const Index n = solver.size();
  if (n == 0) return 0.0;
  std::mt19937_64 generator(20250101);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  VectorX truth(n), b(n), x(n);
  for (Index i = 0; i < n; ++i) truth[i] = uniform(generator);
  op.apply(truth, b);
  solver.solve_into(b, x);
  const double error = (x - truth).norm() / truth.norm();
  return std::isfinite(error) ? error : infinity;
}

}}  // namespace palpate
