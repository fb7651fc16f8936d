// Definitions of solver_laws.hpp.
#pragma once

#include <palpate/testing/solver_laws.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE Violations report_laws(const SolveReport& report, double relative_residual, bool small,
                                      const SolverClaims& claims, const std::string& name) {
  Violations v;
  const double rounding = 1e-15;
  if (!std::isnan(report.relative_residual))
    expect_at_most(v, "report is truthful", std::abs(report.relative_residual - relative_residual),
                   0.5 * relative_residual + rounding, name + ": stated residual");
  expect_true(v, "report is truthful", !report.converged || small, name + ": converged, but the residual is not small");
  expect_true(v, "converges", report.converged, name);
  if (claims.direct) expect_true(v, "report is truthful", report.iterations == 0, name + ": iterations");
  return v;
}

}}}  // namespace palpate::testing
