// Newton's method on potentials with a known minimum.
#include <palpate/integrator/newton.hpp>

#include <Eigen/Cholesky>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

/// Rosenbrock's function: minimum 0 at (1, 1); full Newton steps increase it.
struct Rosenbrock {
  Eigen::Matrix2d second;
  int evaluations = 0;
  Index size() const noexcept { return 2; }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    ++evaluations;
    const double a = 1.0 - x[0], b = x[1] - x[0] * x[0];
    residual << 2.0 * a + 400.0 * b * x[0], -200.0 * b;
    return a * a + 100.0 * b * b;
  }
  bool prepare(const VectorX& x) noexcept {
    second << 2.0 + 1200.0 * x[0] * x[0] - 400.0 * x[1], -400.0 * x[0], -400.0 * x[0], 200.0;
    if (Eigen::LLT<Eigen::Matrix2d>(second).info() != Eigen::Success) second = 1e3 * Eigen::Matrix2d::Identity();
    return true;
  }
  void direction(const VectorX& r, VectorX& d) noexcept { d = second.llt().solve(r); }
  double scale() const noexcept { return 1.0; }
  double rounding() const noexcept { return 0.0; }
};

/// x - log x, defined for x > 0 only: from x = 10 a full step leaves the domain.
struct Barrier {
  double second = 0.0;
  bool left = false;
  Index size() const noexcept { return 1; }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    if (!(x[0] > 0.0)) {
      left = true;
      return infinity;
    }
    residual[0] = 1.0 / x[0] - 1.0;
    return x[0] - std::log(x[0]);
  }
  bool prepare(const VectorX& x) noexcept {
    second = 1.0 / (x[0] * x[0]);
    return true;
  }
  void direction(const VectorX& r, VectorX& d) noexcept { d = r / second; }
  double scale() const noexcept { return 1.0; }
  double rounding() const noexcept { return 0.0; }
};

/// x: no minimum.
struct Slope {
  Index size() const noexcept { return 1; }
  double evaluate(const VectorX& x, VectorX& residual) noexcept {
    residual[0] = -1.0;
    return x[0];
  }
  bool prepare(const VectorX&) noexcept { return true; }
  void direction(const VectorX& r, VectorX& d) noexcept { d = r; }
  double scale() const noexcept { return 1.0; }
  double rounding() const noexcept { return 0.0; }
};

static_assert(detail::NewtonProblem<Rosenbrock> && detail::NewtonProblem<Barrier> && detail::NewtonProblem<Slope>);
static_assert(!detail::NewtonProblem<int>);

}  // namespace

TEST_CASE("Newton's method finds the minimum of Rosenbrock's function", "[integrator][newton]") {
  Rosenbrock problem;
  detail::NewtonMethod newton(2);
  VectorX x = Eigen::Vector2d(-1.2, 1.0);
  const NewtonReport report = newton.solve(problem, x);
  CHECK(report.converged);
  CHECK(report.halvings > 0);
  CHECK(report.relative_residual <= 1e-10);
  CHECK((x - Eigen::Vector2d(1.0, 1.0)).norm() <= 1e-10);
}

TEST_CASE("Newton's method stays inside the domain", "[integrator][newton]") {
  Barrier problem;
  detail::NewtonMethod newton(1);
  VectorX x = VectorX::Constant(1, 10.0);
  const NewtonReport report = newton.solve(problem, x);
  CHECK(problem.left);  // a step out of the domain was tried and rejected
  CHECK(report.converged);
  CHECK(std::abs(x[0] - 1.0) <= 1e-10);
  x[0] = -1.0;
  CHECK_FALSE(newton.solve(problem, x).converged);
  CHECK(x[0] == -1.0);
}

TEST_CASE("Newton's method converges quadratically", "[integrator][newton]") {
  Barrier problem;
  double error = 0.1;
  for (int k = 1; k <= 3; ++k) {
    VectorX x = VectorX::Constant(1, 0.9);
    const NewtonReport report = detail::NewtonMethod(1, {.maximum_iterations = k}).solve(problem, x);
    CHECK(report.iterations == k);
    error *= error;  // of x - log x exactly
    CHECK(std::abs(1.0 - x[0] - error) <= 1e-15);
  }
}

TEST_CASE("Newton's method stops without a minimum, and makes no step at a minimum", "[integrator][newton]") {
  Slope slope;
  VectorX x = VectorX::Zero(1);
  const NewtonReport report = detail::NewtonMethod(1, {.maximum_iterations = 7}).solve(slope, x);
  CHECK_FALSE(report.converged);
  CHECK(report.iterations == 7);
  Barrier barrier;
  x[0] = 1.0;
  const NewtonReport at_once = detail::NewtonMethod(1).solve(barrier, x);
  CHECK(at_once.converged);
  CHECK(at_once.iterations == 0);
}

TEST_CASE("unusable Newton parameters are refused", "[integrator][newton][extreme]") {
  const auto make = [](const NewtonParameters& p) { detail::NewtonMethod newton(2, p); };
  make({.maximum_iterations = 1, .tolerance = 0.0, .maximum_halvings = 0});
  CHECK_REFUSED(SetupErrorKind::bad_argument, make({.maximum_iterations = 0}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, make({.maximum_iterations = -1}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, make({.maximum_halvings = -1}));
  for (const double tolerance : {-1e-10, std::nan(""), infinity})
    CHECK_REFUSED(SetupErrorKind::bad_argument, make({.tolerance = tolerance}));
}
