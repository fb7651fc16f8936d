// Definitions of assembler_laws.hpp.
#pragma once

#include <palpate/testing/assembler_laws.hpp>

#include <palpate/testing/dense.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE VectorX random_vector(Random& random, Index n) {
  VectorX v(n);
  for (Index i = 0; i < n; ++i) v[i] = random.uniform(-1.0, 1.0);
  return v;
}

PALPATE_INLINE Violations zero_mode_laws(const MatrixX& dense, Index rigid_motions) {
  Violations v;
  const VectorX lambda = symmetric_eigenvalues(dense);
  const double rounding = 1e-13 * lambda[lambda.size() - 1] * std::sqrt(static_cast<double>(lambda.size()));
  Index zero = 0;
  for (Index i = 0; i < lambda.size(); ++i) zero += std::abs(lambda[i]) <= rounding ? 1 : 0;
  expect_true(v, "exact zero modes", zero == rigid_motions,
              std::to_string(zero) + " instead of " + std::to_string(rigid_motions));
  expect_at_least(v, "no negative mode", lambda[0], -rounding);
  return v;
}

}}}  // namespace palpate::testing
