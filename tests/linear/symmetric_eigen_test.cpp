#include <palpate/linear/detail/symmetric_eigen.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>

#include "catch.hpp"

using namespace palpate;

namespace {

/// Q diag(values) Q^T with a random rotation Q.
MatrixX with_eigenvalues(const VectorX& values, testing::Random& random) {
  const Index n = values.size();
  MatrixX a(n, n);
  for (double& x : a.reshaped()) x = random.uniform(-1.0, 1.0);
  MatrixX q = Eigen::SelfAdjointEigenSolver<MatrixX>(a + a.transpose()).eigenvectors();
  return q * values.asDiagonal() * q.transpose();
}

void check(const MatrixX& symmetric) {
  const double size = symmetric.norm();
  const VectorX exact = Eigen::SelfAdjointEigenSolver<MatrixX>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
  MatrixX vectors = symmetric, work = symmetric;
  VectorX values, alone;
  detail::symmetric_eigen(vectors, values);
  detail::symmetric_eigenvalues(work, alone);
  CHECK((values - exact).norm() <= 1e-14 * std::sqrt(static_cast<double>(exact.size())) * size);
  CHECK((alone - exact).norm() <= 1e-14 * std::sqrt(static_cast<double>(exact.size())) * size);
  CHECK((symmetric * vectors - vectors * values.asDiagonal()).norm() <= 1e-13 * size);
}

}  // namespace

TEST_CASE("eigenvalues agree with Eigen's, with eigenvectors and without them", "[linear][eigen]") {
  testing::Random random(11);
  for (Index n : {1, 2, 3, 12, 24, 30, 60}) {
    INFO("n = " << n);
    VectorX values(n);
    for (double& x : values) x = random.uniform(-1.0, 1.0);
    check(with_eigenvalues(values, random));
    check(1e100 * with_eigenvalues(values, random));
    values.tail(n - n / 2).setConstant(0.5);  // repeated
    check(with_eigenvalues(values, random));
    values.tail(n - 1).setZero();  // of rank one
    check(with_eigenvalues(values, random));
    check(MatrixX(values.asDiagonal()));
    check(MatrixX::Zero(n, n));
  }
}
