#pragma once

#include "assembly/bodies.hpp"
#include "local/closed_form.hpp"

#include <palpate/linear/conjugate_gradient.hpp>

#include <Eigen/QR>

namespace test {

/// The stiffness of the free dofs of a constrained sphere of liver, lower half.
inline SparseMatrix sphere_stiffness(int refinement, const LinearElastic& m = liver) {
  const Body<Tet4> body{sphere_tet4(0.05, refinement), {m.elasticity()}, {m.density}, {Vector6::Zero()}};  // unchecked
  std::vector<NodeId> below;
  for (NodeId i = 0; i < body.mesh.node_count(); ++i)
    if (body.mesh.position(i)[2] < -0.02) below.push_back(i);
  return free_matrix(assemble_stiffness<Tet4>(body, {}), conditions_of(body.mesh, Scene().fix(below)));
}

/// Entries between -1 and 1.
inline VectorX random_vector(Index n, std::uint64_t seed) {
  testing::Random random(seed);
  VectorX v(n);
  for (Index i = 0; i < n; ++i) v[i] = random.uniform(-1.0, 1.0);
  return v;
}

/// A full symmetric matrix from its lower half.
inline MatrixX full(const SparseMatrix& lower) {
  return MatrixX(MatrixX(lower).selfadjointView<Eigen::Lower>());
}

/// The lower half of a matrix, in the form the sparse solver takes.
inline SparseMatrix lower_half(const MatrixX& m) {
  return SparseMatrix(MatrixX(m.triangularView<Eigen::Lower>()).sparseView());
}

/// The matrix as an operator.
inline detail::DenseOperator op_of(const MatrixX& m) {
  return detail::DenseOperator(m);
}

/// Q diag(lambda) Q^T with eigenvalues spread evenly over the decades from 1 to 1 / condition.
inline MatrixX with_condition(Index n, double condition) {
  testing::Random random(1995);
  MatrixX a(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) a(i, j) = random.uniform(-1.0, 1.0);
  const MatrixX q = Eigen::HouseholderQR<MatrixX>(a).householderQ() * MatrixX::Identity(n, n);
  VectorX lambda(n);
  for (Index i = 0; i < n; ++i) lambda[i] = std::pow(condition, -static_cast<double>(i) / static_cast<double>(n - 1));
  const MatrixX m = q * lambda.asDiagonal() * q.transpose();
  return 0.5 * (m + m.transpose());
}

/// Solution in long double.
inline VectorX exact_solution(const MatrixX& m, const VectorX& b) {
  using Real = long double;
  const DenseVector<Real> x = Eigen::LLT<DenseMatrix<Real>>(m.cast<Real>()).solve(b.cast<Real>());
  return x.cast<double>();
}

/// 1-norm condition number.
inline double exact_condition(const MatrixX& m) {
  using Real = long double;
  const Index n = m.rows();
  const DenseMatrix<Real> inverse =
      Eigen::LLT<DenseMatrix<Real>>(m.cast<Real>()).solve(DenseMatrix<Real>::Identity(n, n));
  return m.cwiseAbs().colwise().sum().maxCoeff() * static_cast<double>(inverse.cwiseAbs().colwise().sum().maxCoeff());
}

}  // namespace test
