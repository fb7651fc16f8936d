// The laws of StaticSystem (concepts/linear_solver.hpp).
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/dense.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/violation.hpp>

#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// The inverse of a small operator by dense Cholesky, column by column: the reference for condensed solutions.
template <palpate::detail::SpdOperator Op>
MatrixX full_inverse(const Op& op) {
  const Index n = op.size();
  MatrixX k(n, n);
  VectorX y(n);
  for (Index j = 0; j < n; ++j) {
    op.apply(VectorX::Unit(n, j), y);
    k.col(j) = y;
  }
  return positive_definite_inverse(k);
}

/// "displacement equals the full solve" under a load on kept dofs only, on condensed dofs only, and on all of them;
/// "zero load gives zero" exactly.
template <StaticSystem S>
Violations condensed_answer_laws(const MatrixX& inverse, S& system, std::span<const Index> kept, double tolerance) {
  Violations v;
  const Index n = inverse.rows();
  std::vector<char> is_kept(static_cast<std::size_t>(n), 0);
  for (Index i : kept) is_kept[static_cast<std::size_t>(i)] = 1;
  Random random(1965);
  for (const char* where : {"kept", "condensed", "all"}) {
    VectorX b(n), x = VectorX::Constant(n, std::numeric_limits<double>::quiet_NaN());
    for (Index i = 0; i < n; ++i) {
      const bool loaded = where[0] == 'a' || (is_kept[static_cast<std::size_t>(i)] != 0) == (where[0] == 'k');
      b[i] = loaded ? random.uniform(-1.0, 1.0) : 0.0;
    }
    const SolveReport report = system.solve_into(b, x);
    const VectorX truth = inverse * b;
    expect_true(v, "converges", report.converged, where);
    expect_at_most(v, "displacement equals the full solve", (x - truth).norm(), tolerance * truth.norm(),
                   std::string("load on dofs: ") + where);
  }
  VectorX zero = VectorX::Constant(n, 1.0);
  system.solve_into(VectorX::Zero(n), zero);
  expect_true(v, "zero load gives zero", zero.isZero(0.0));
  return v;
}

/// "compliance equals the full solve", "compliance is symmetric", "compliance is positive definite", and "same column
/// twice".
template <StaticSystem S>
Violations compliance_laws(const MatrixX& inverse, S& system, std::span<const Index> kept, double tolerance) {
  Violations v;
  const Index k = static_cast<Index>(kept.size());
  MatrixX c(k, k), truth(k, k);
  VectorX column(k);
  bool converged = true, same = true;
  for (Index j = 0; j < k; ++j) {
    column.setConstant(std::numeric_limits<double>::quiet_NaN());
    converged = system.compliance_column(j, column).converged && converged;
    c.col(j) = column;
    for (Index i = 0; i < k; ++i)
      truth(i, j) = inverse(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]);
  }
  for (Index j = k; j-- > 0;) {
    system.compliance_column(j, column);
    same = same && column == c.col(j);
  }
  expect_true(v, "converges", converged, "compliance column");
  expect_true(v, "same column twice", same);
  if (k == 0) return v;
  const double scale = truth.cwiseAbs().maxCoeff();
  expect_at_most(v, "compliance equals the full solve", (c - truth).cwiseAbs().maxCoeff(), tolerance * scale);
  expect_at_most(v, "compliance is symmetric", (c - c.transpose()).cwiseAbs().maxCoeff(), tolerance * scale);
  expect_true(v, "compliance is positive definite", c.allFinite() && is_positive_definite(0.5 * (c + c.transpose())));
  return v;
}

/// Laws of a static system with the dofs `kept` (in its order) of the operator it was constructed from. O(n^3): for
/// small systems.
template <palpate::detail::SpdOperator Op, StaticSystem S>
Violations condensation_laws(const Op& op, S& system, std::span<const Index> kept, double tolerance = 1e-11) {
  Violations v;
  expect_true(v, "size", static_cast<Index>(system.size()) == static_cast<Index>(op.size()));
  expect_true(v, "number of kept dofs", static_cast<Index>(system.kept()) == static_cast<Index>(kept.size()));
  if (!v.empty()) return v;
  const MatrixX inverse = full_inverse(op);
  append(v, condensed_answer_laws(inverse, system, kept, tolerance));
  append(v, compliance_laws(inverse, system, kept, tolerance));
  return v;
}

}}}  // namespace palpate::testing
