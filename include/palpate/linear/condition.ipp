// Definitions of condition.hpp.
#pragma once

#include <palpate/linear/condition.hpp>
#include <palpate/linear/vector_kernels.hpp>

#include <cmath>
#include <random>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double inverse_norm_estimate(SolverView solver) {
  const Index n = solver.size();
  if (n == 0) return 0.0;
  VectorX x(n), y(n), z(n);
  detail::fill(x, 1.0 / static_cast<double>(n));
  double estimate = 0.0;
  for (int sweep = 0; sweep < 5; ++sweep) {
    solver.solve_into(x, y);
    double norm = 0.0;
    for (Index i = 0; i < n; ++i) norm += std::abs(y.data()[i]);
    if (!std::isfinite(norm)) return norm;
    if (sweep > 0 && norm <= estimate) break;
    estimate = norm;
    for (Index i = 0; i < n; ++i) x.data()[i] = y.data()[i] >= 0.0 ? 1.0 : -1.0;
    solver.solve_into(x, z);
    Index largest = 0;
    for (Index i = 1; i < n; ++i)
      if (std::abs(z.data()[i]) > std::abs(z.data()[largest])) largest = i;
    if (sweep > 0 && std::abs(z.data()[largest]) <= std::abs(detail::dot(z, x)) / static_cast<double>(n)) break;
    detail::fill(x, 0.0);
    x.data()[largest] = 1.0;
  }
  return estimate;
}

PALPATE_INLINE double probe_error(const OperatorView& op, SolverView solver) {
  const Index n = solver.size();
  if (n == 0) return 0.0;
  std::mt19937_64 generator(20250101);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  VectorX truth(n), b(n), x(n);
  for (Index i = 0; i < n; ++i) truth.data()[i] = uniform(generator);
  op.apply(truth, b);
  solver.solve_into(b, x);
  detail::add_scaled(x, -1.0, truth);
  const double error = detail::norm(x) / detail::norm(truth);
  return std::isfinite(error) ? error : infinity;
}

}}  // namespace palpate
