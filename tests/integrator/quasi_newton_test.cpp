// The quasi-Newton method on functions with known minima.
#include <palpate/integrator/quasi_newton.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "catch.hpp"
#include "refused.hpp"

#include <cmath>

using namespace palpate;

namespace {

/// Rosenbrock's function in pairs of variables: minimum 0 at (1, 1, ...). Infinite for x_0 > 3.
struct RosenbrockPairs {
  int evaluations = 0;
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    ++evaluations;
    if (x[0] > 3.0) return infinity;
    double sum = 0.0;
    for (Index i = 0; i < x.size(); i += 2) {
      const double a = 1.0 - x[i], b = x[i + 1] - x[i] * x[i];
      sum += a * a + 100.0 * b * b;
      residual[i] = 2.0 * a + 400.0 * b * x[i];
      residual[i + 1] = -200.0 * b;
    }
    return sum;
  }
  void precondition(const VectorX& r, VectorX& d) noexcept { d = r / factor; }
  double scale() const noexcept { return 100.0; }
  double rounding() const noexcept { return 1e-13; }
  double potential_rounding() const noexcept { return 1e-15; }
  double energy_scale() const noexcept { return 1.0; }
  double energy_rounding() const noexcept { return 1e-30; }
  bool is_uneven() const noexcept { return false; }
  double factor = 200.0;
};

/// x^T A x / 2 - b x with a factor of A.
struct FactorisedQuadratic {
  Eigen::Matrix3d a = Eigen::Vector3d(1.0, 10.0, 100.0).asDiagonal();
  VectorX b = VectorX::Ones(3);
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    residual = b - a * x;
    return 0.5 * x.dot(a * x) - b.dot(x);
  }
  void precondition(const VectorX& r, VectorX& d) noexcept { d = r.cwiseQuotient(a.diagonal()); }
  double scale() const noexcept { return 1.0; }
  double rounding() const noexcept { return floor; }
  double potential_rounding() const noexcept { return 1e-14; }
  double energy_scale() const noexcept { return 1.0; }
  double energy_rounding() const noexcept { return floor * floor; }
  bool is_uneven() const noexcept { return uneven; }
  double floor = 1e-14;
  bool uneven = false;
};

}  // namespace

TEST_CASE("an exact factor needs one iteration", "[integrator][quasi_newton]") {
  FactorisedQuadratic problem;
  QuasiNewtonMethod method(3);
  VectorX x = VectorX::Zero(3);
  method.start(problem, x);
  const QuasiNewtonReport report = method.solve(problem, x, {});
  CHECK(report.converged);
  CHECK(report.iterations == 1);
  CHECK((problem.a * x - problem.b).norm() < 1e-12);
}

TEST_CASE("a response that is improved again and again is that of the second derivative",
          "[integrator][quasi_newton]") {
  FactorisedQuadratic problem;
  problem.a(0, 1) = problem.a(1, 0) = 2.0;  // the factor is that of the diagonal
  problem.a(1, 2) = problem.a(2, 1) = -20.0;
  QuasiNewtonMethod method(3);
  VectorX x = VectorX::Zero(3), d = VectorX::Zero(3), f = problem.b;
  method.start(problem, x);
  method.solve(problem, x, {});
  const auto energy = [&] { return 0.5 * d.dot(problem.a * d) - f.dot(d); };
  double last = 0.0;
  for (int k = 0; k < 10; ++k) {
    CHECK(method.improve(problem, x, f, d));
    CHECK(energy() <= last + 1e-9);
    last = energy();
  }
  CHECK((problem.a * d - f).norm() < 1e-3 * f.norm());
  f = Eigen::Vector3d(0.0, -1.0, 3.0);  // it follows another right-hand side
  for (int k = 0; k < 10; ++k) method.improve(problem, x, f, d);
  CHECK((problem.a * d - f).norm() < 1e-3 * f.norm());
}

TEST_CASE("there is no response where the second derivative is not positive", "[integrator][quasi_newton]") {
  FactorisedQuadratic problem;
  QuasiNewtonMethod method(3);
  VectorX x = VectorX::Zero(3), d = VectorX::Zero(3);
  method.start(problem, x);
  problem.a = -problem.a;
  CHECK_FALSE(method.improve(problem, x, problem.b, d));
  CHECK(d.isZero(0.0));
}

TEST_CASE("Rosenbrock's function is minimised, monotonically, without allocation", "[integrator][quasi_newton]") {
  RosenbrockPairs problem;
  const Index n = 10;
  QuasiNewtonMethod method(n);
  VectorX x = VectorX::Constant(n, -1.2);
  VectorX d = VectorX::Zero(n);
  const VectorX f = VectorX::Ones(n);
  double last = method.start(problem, x);
  const testing::AllocationScope scope;
  QuasiNewtonReport report;
  bool monotone = true;
  for (int k = 0; k < 300 && method.residual().norm() > 1e-10; ++k) {
    if (!method.iterate(problem, x, report)) break;
    monotone = monotone && method.potential() <= last;
    last = method.potential();
  }
  const bool responds = method.improve(problem, x, f, d);
  CHECK(scope.allocations() == 0);
  CHECK(responds);
  CHECK(monotone);
  CHECK((x - VectorX::Ones(n)).norm() < 1e-8);
}

TEST_CASE("a step out of the domain is shortened", "[integrator][quasi_newton]") {
  RosenbrockPairs problem;
  problem.factor = 1e-3;  // the first steps are far too long
  QuasiNewtonMethod method(2);
  VectorX x(2);
  x << 0.5, 0.0;
  const double before = method.start(problem, x);
  const QuasiNewtonReport report =
      method.solve(problem, x, {.maximum_iterations = 500, .tolerance = 1e-10, .maximum_evaluations = 5000});
  CHECK(report.converged);
  CHECK(method.potential() < before);
  CHECK((x - VectorX::Ones(2)).norm() < 1e-6);
}

TEST_CASE("a residual in soft directions only is seen by its energy", "[integrator][quasi_newton]") {
  FactorisedQuadratic problem;
  problem.a = Eigen::Vector3d(1e-6, 10.0, 100.0).asDiagonal();
  problem.b = VectorX::Unit(3, 0) * 1e-6;  // moves x_0 by 1
  QuasiNewtonMethod method(3);
  const auto solved = [&] {
    VectorX x = VectorX::Zero(3);
    method.start(problem, x);
    const QuasiNewtonReport report = method.solve(problem, x, {.tolerance = 1e-4});
    CHECK(report.converged);
    return x[0];
  };
  CHECK(solved() == 0.0);  // the norm of the residual is below the tolerance
  problem.uneven = true;
  CHECK(std::abs(solved() - 1.0) < 1e-9);
  problem.uneven = false;
  problem.floor = 1e-5;  // above the norm of the residual, but not above its energy
  CHECK(std::abs(solved() - 1.0) < 1e-9);
  problem.floor = 1e-2;
  CHECK(solved() == 0.0);
}

TEST_CASE("a limit on iterations ends with the best state", "[integrator][quasi_newton]") {
  RosenbrockPairs problem;
  QuasiNewtonMethod method(2);
  VectorX x = VectorX::Constant(2, -1.2);
  const double before = method.start(problem, x);
  const QuasiNewtonReport report = method.solve(problem, x, {.maximum_iterations = 3});
  CHECK(!report.converged);
  CHECK(report.iterations == 3);
  CHECK(report.relative_residual > 1e-6);
  VectorX residual(2);
  CHECK(problem.evaluate(x, residual) == method.potential());
  CHECK(method.potential() < before);
}

TEST_CASE("a quasi-Newton method needs a memory", "[integrator][quasi_newton]") {
  CHECK(test::refusal_kind([] { QuasiNewtonMethod method(3, 0); }) == "bad_argument");
}
