// Definitions of condition.hpp.
#pragma once

#include <palpate/linear/condition.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Writes the signs of y; returns whether any has changed.
inline bool take_signs(const VectorX& y, VectorX& signs) noexcept {
  bool changed = false;
  for (Index i = 0; i < y.size(); ++i) {
    const double sign = y.data()[i] >= 0.0 ? 1.0 : -1.0;
    changed = changed || sign != signs.data()[i];
    signs.data()[i] = sign;
  }
  return changed;
}

PALPATE_INLINE double inverse_norm_estimate(SolverView solver) {
  const Index n = solver.size();
  if (n == 0) return 0.0;
  VectorX x(n), y(n), z(n), signs = zeros(n);
  fill(x, 1.0 / static_cast<double>(n));
  double estimate = 0.0;
  for (int sweep = 0; sweep < 5; ++sweep) {
    solver.solve_into(x, y);
    double norm = 0.0;
    for (Index i = 0; i < n; ++i) norm += std::abs(y.data()[i]);
    if (!std::isfinite(norm)) return norm;
    if (norm <= estimate) break;
    estimate = norm;
    if (!take_signs(y, signs)) break;
    solver.solve_into(signs, z);
    Index largest = 0;
    for (Index i = 1; i < n; ++i)
      if (std::abs(z.data()[i]) > std::abs(z.data()[largest])) largest = i;
    if (std::abs(z.data()[largest]) <= dot(z, x)) break;  // a local maximum of the norm
    fill(x, 0.0);
    x.data()[largest] = 1.0;
  }
  return estimate;
}

/// Numbers in [-1, 1), the same in every call: splitmix64 (Steele, Lea and Flood 2014), which saves all programs the
/// header <random>.
inline VectorX random_answer(Index n) {
  std::uint64_t state = 20250101;
  VectorX answer(n);
  for (Index i = 0; i < n; ++i) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    answer.data()[i] = static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }
  return answer;
}

/// |x - truth| / |truth| of a solve whose exact solution is known; infinity when x is not finite.
inline double error_of_solve(const OperatorView& op, SolverView solver, const VectorX& truth) {
  VectorX b(truth.size()), x(truth.size());
  op.apply(truth, b);
  solver.solve_into(b, x);
  add_scaled(x, -1.0, truth);
  const double error = norm(x) / norm(truth);
  return std::isfinite(error) ? error : infinity;
}

/// |A^n x| / |A^(n-1) x| for a random x: a lower bound of |A|_2.
template <class Apply>
double norm_by_iteration(Index size, int steps, Apply apply) {
  VectorX x = random_answer(size), y(size);
  double length = norm(x);
  for (int step = 0; step < steps; ++step) {
    for (Index i = 0; i < size; ++i) x.data()[i] /= length;
    apply(x, y);
    length = norm(y);
    if (!(length > 0.0 && std::isfinite(length))) return std::numeric_limits<double>::quiet_NaN();
    x.swap(y);
  }
  return length;
}

PALPATE_INLINE double condition_by_iteration(const OperatorView& op, SolverView solver) {
  const Index n = solver.size();
  if (n == 0) return 0.0;
  return norm_by_iteration(n, 10, [&](const VectorX& x, VectorX& y) { op.apply(x, y); }) *
         norm_by_iteration(n, 2, [&](const VectorX& x, VectorX& y) { solver.solve_into(x, y); });
}

}  // namespace detail

PALPATE_INLINE double probe_error(const detail::OperatorView& op, detail::SolverView solver) {
  if (solver.size() == 0) return 0.0;
  return detail::error_of_solve(op, solver, detail::random_answer(solver.size()));
}

namespace detail {

PALPATE_INLINE SoftestMotion probe_softest_motion(const OperatorView& op, SolverView solver) {
  const Index n = solver.size();
  if (n == 0) return {};
  VectorX motion = random_answer(n), x(n);
  for (int sweep = 0; sweep < 2; ++sweep) {
    solver.solve_into(motion, x);
    const double length = norm(x);
    if (!(length > 0.0 && std::isfinite(length))) return {infinity, 0};
    for (Index i = 0; i < n; ++i) motion.data()[i] = x.data()[i] / length;
  }
  SoftestMotion softest{error_of_solve(op, solver, motion), 0};
  for (Index i = 1; i < n; ++i)
    if (std::abs(motion.data()[i]) > std::abs(motion.data()[softest.largest])) softest.largest = i;
  return softest;
}

}  // namespace detail

}}  // namespace palpate
