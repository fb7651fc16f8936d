// Dense linear algebra of the laws. Not templates: Eigen's decompositions take seconds to compile for every size.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// In ascending order. Only the lower triangle is read.
VectorX symmetric_eigenvalues(const MatrixX& symmetric);
MatrixX positive_definite_inverse(const MatrixX& positive_definite);
bool is_positive_definite(const MatrixX& symmetric);

inline VectorX symmetric_eigenvalues(const MatrixX& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixX>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

inline MatrixX positive_definite_inverse(const MatrixX& positive_definite) {
  const Index n = positive_definite.rows();
  return Eigen::LLT<MatrixX>(positive_definite).solve(MatrixX::Identity(n, n));
}

inline bool is_positive_definite(const MatrixX& symmetric) {
  return Eigen::LLT<MatrixX>(symmetric).info() == Eigen::Success;
}

}}}  // namespace palpate::testing
