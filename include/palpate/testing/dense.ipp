// Definitions of dense.hpp.
#pragma once

#include <palpate/testing/dense.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE VectorX symmetric_eigenvalues(const MatrixX& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixX>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

PALPATE_INLINE MatrixX positive_definite_inverse(const MatrixX& positive_definite) {
  const Index n = positive_definite.rows();
  return Eigen::LLT<MatrixX>(positive_definite).solve(MatrixX::Identity(n, n));
}

PALPATE_INLINE bool is_positive_definite(const MatrixX& symmetric) {
  return Eigen::LLT<MatrixX>(symmetric).info() == Eigen::Success;
}

}}}  // namespace palpate::testing
