// Conjugate gradients with bounded work: the reported error agrees with the true error.
#include <palpate/linear/bounded_conjugate_gradient.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "catch.hpp"

#include <cmath>

using namespace palpate;

namespace {

/// Dense, with given eigenvalues; preconditioned by its diagonal.
struct GivenSpectrum {
  MatrixX k;
  VectorX diagonal;

  GivenSpectrum(Index size, double condition) {
    testing::Random random(3);
    const MatrixX a = MatrixX::NullaryExpr(size, size, [&] { return random.uniform(-1.0, 1.0); });
    const MatrixX q = a.householderQr().householderQ();
    const VectorX values =
        VectorX::NullaryExpr(size, [&](Index i) { return std::pow(condition, double(i) / double(size - 1)); });
    k = q * values.asDiagonal() * q.transpose();
    diagonal = k.diagonal();
  }
  Index size() const noexcept { return k.rows(); }
  void apply(const VectorX& x, VectorX& y) const noexcept { y.noalias() = k * x; }
  void precondition(const VectorX& x, VectorX& y) const noexcept { y = x.cwiseQuotient(diagonal); }
};

double energy_norm(const GivenSpectrum& op, const VectorX& x) {
  return std::sqrt(x.dot(op.k * x));
}

}  // namespace

TEST_CASE("the energy norm of the error is below the tolerance and close to the reported error", "[linear][bounded]") {
  for (const double condition : {2.0, 10.0, 100.0}) {
    const GivenSpectrum op(60, condition);
    const VectorX b = VectorX::LinSpaced(60, -1.0, 2.0), exact = op.k.llt().solve(b);
    detail::BoundedConjugateGradient solver(60);
    VectorX x(60);
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-6}) {
      const auto report = solver.solve_into(op, b, x, {200, tolerance});
      const double error = energy_norm(op, x - exact) / energy_norm(op, exact);
      INFO("condition " << condition << ", tolerance " << tolerance << ": " << report.iterations << " iterations, "
                        << report.error << " reported, error " << error);
      CHECK(report.converged);
      CHECK(error <= 3.0 * tolerance);  // the estimate omits what further iterations would add
      CHECK(report.error <= tolerance);
    }
  }
}

TEST_CASE("the work is bounded, and fewer iterations leave a larger error", "[linear][bounded]") {
  const GivenSpectrum op(60, 1e4);
  const VectorX b = VectorX::Ones(60), exact = op.k.llt().solve(b);
  detail::BoundedConjugateGradient solver(60);
  VectorX x(60);
  double before = 1.0;
  for (int most = 1; most <= 8; ++most) {
    const auto report = solver.solve_into(op, b, x, {most, 0.0});
    const double error = energy_norm(op, x - exact) / energy_norm(op, exact);
    CHECK(report.iterations == most);
    CHECK_FALSE(report.converged);
    CHECK(error < before);
    before = error;
  }
}

TEST_CASE("zero load, non-finite load and negative curvature", "[linear][bounded]") {
  GivenSpectrum op(12, 10.0);
  detail::BoundedConjugateGradient solver(12);
  VectorX x = VectorX::Ones(12);
  const auto nothing = solver.solve_into(op, VectorX::Zero(12), x, {});
  CHECK(nothing.converged);
  CHECK(nothing.iterations == 0);
  CHECK(x.isZero());
  for (const double bad : {std::nan(""), infinity}) {
    const auto report = solver.solve_into(op, VectorX::Constant(12, bad), x, {});
    CHECK_FALSE(report.converged);
    CHECK(x.allFinite());
  }
  op.k = -op.k;
  CHECK_FALSE(solver.solve_into(op, VectorX::Ones(12), x, {}).converged);
  CHECK(x.allFinite());
}

TEST_CASE("a bounded solve does not allocate", "[linear][bounded]") {
  const GivenSpectrum op(40, 50.0);
  detail::BoundedConjugateGradient solver(40);
  const VectorX b = VectorX::Ones(40);
  VectorX x(40);
  const testing::AllocationScope scope;
  solver.solve_into(op, b, x, {30, 1e-8});
  CHECK(scope.allocations() == 0);
}
