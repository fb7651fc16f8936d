// Solvers against a dense reference in long double, on well-posed matrices.
#include <palpate/condensation/static_systems.hpp>
#include <palpate/linear/condition.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/testing/solver_laws.hpp>

#include <thread>

#include "linear/systems.hpp"

using namespace test;

namespace {

template <class S>
S make(const MatrixX& m) {
  if constexpr (std::same_as<S, SparseCholesky>)
    return S(lower_half(m), {});
  else
    return S(m, {});
}

template <class S>
constexpr testing::SolverClaims claims() {
  if constexpr (std::same_as<S, DenseInverse<float>>) return {1e-6, true};
  if constexpr (std::same_as<S, detail::DenseConjugateGradient>) return {1e-11, false};
  return {1e-13, true};
}

/// Largest relative error over a few loads.
template <class S>
double worst_error(const MatrixX& m, S& solver) {
  testing::Random random(29);
  double worst = 0.0;
  for (int trial = 0; trial < 4; ++trial) {
    VectorX b(m.rows()), x(m.rows());
    for (Index i = 0; i < b.size(); ++i) b[i] = random.uniform(-1.0, 1.0);
    solver.solve_into(b, x);
    const VectorX truth = exact_solution(m, b);
    worst = std::max(worst, (x - truth).norm() / truth.norm());
  }
  return worst;
}

}  // namespace

TEMPLATE_TEST_CASE("solvers pass the law suite and agree with long double", "[linear][laws]", SparseCholesky,
                   DenseCholesky, DenseInverse<double>, DenseInverse<float>, detail::DenseConjugateGradient) {
  using S = TestType;
  const MatrixX k = full(sphere_stiffness(2));
  S solver = make<S>(k);
  CHECK(testing::describe(testing::solver_laws(op_of(k), solver, claims<S>())) == "");
  const double condition = exact_condition(k);
  CHECK(worst_error(k, solver) <= claims<S>().tolerance * condition);
  SECTION("in any unit") {
    for (double unit : {1e-12, 1e12}) {
      S scaled = make<S>(unit * k);
      CHECK(worst_error(unit * k, scaled) <= claims<S>().tolerance * condition);
    }
  }
  SECTION("one equation") {
    const MatrixX one = MatrixX::Constant(1, 1, 4.0);
    S single = make<S>(one);
    VectorX x(1);
    single.solve_into(VectorX::Constant(1, 2.0), x);
    CHECK(x[0] == 0.5);
  }
  SECTION("no equation") {
    S none = make<S>(MatrixX(0, 0));
    CHECK(none.size() == 0);
    VectorX x(0);
    CHECK(none.solve_into(VectorX(0), x).converged);
  }
}

TEMPLATE_TEST_CASE("copies solve at the same time with the same answer", "[linear][threads]", SparseCholesky,
                   detail::DenseConjugateGradient, DenseInverse<double>) {
  using S = TestType;
  const MatrixX k = full(sphere_stiffness(2));
  S original = make<S>(k);
  std::vector<S> copies(3, original);
  std::vector<VectorX> loads, expected, found(3, VectorX(k.rows()));
  for (Index i = 0; i < 3; ++i) {
    loads.push_back(VectorX::Unit(k.rows(), 5 * i));
    expected.emplace_back(k.rows());
    original.solve_into(loads.back(), expected.back());
  }
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 3; ++i)
    threads.emplace_back([&, i] {
      for (int again = 0; again < 50; ++again) copies[i].solve_into(loads[i], found[i]);
    });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < 3; ++i) CHECK(found[i] == expected[i]);
}

TEST_CASE("a block of right-hand sides equals single solves", "[linear]") {
  const SparseMatrix lower = sphere_stiffness(2);
  SparseCholesky solver(lower, {});
  testing::Random random(31);
  MatrixX b(lower.rows(), 13);
  for (Index j = 0; j < b.cols(); ++j)
    for (Index i = 0; i < b.rows(); ++i) b(i, j) = random.uniform(-1.0, 1.0);
  const MatrixX all = solver.solve(b);
  VectorX x(lower.rows());
  for (Index j = 0; j < b.cols(); ++j) {
    solver.solve_into(b.col(j), x);
    CHECK(largest(all.col(j) - x) <= 1e-14 * largest(x));
  }
  CHECK(solver.solve(MatrixX(lower.rows(), 0)).cols() == 0);
  x = b.col(0);
  solver.solve_into(x, x);  // in place
  CHECK(largest(all.col(0) - x) <= 1e-14 * largest(x));
  CHECK(solver.bytes() > 0);
  CHECK(solver.factor_nonzeros() >= lower.nonZeros() - lower.rows());
}

TEST_CASE("a factorisation can be cancelled", "[linear]") {
  SetupLimits limits;
  limits.progress = [](const Progress&) { return false; };
  CHECK_REFUSED(SetupErrorKind::cancelled, SparseCholesky(sphere_stiffness(1), limits));
}

TEST_CASE("conjugate gradients report when they do not converge", "[linear][cg]") {
  SECTION("too few iterations") {
    const MatrixX k = full(sphere_stiffness(2));
    const detail::DenseOperator op(k);
    detail::ConjugateGradientSolver solver(op.size(), {1e-12, 5});
    VectorX x(op.size());
    const VectorX b = VectorX::Ones(op.size());
    const SolveReport report = solver.solve_into(op, b, x);
    CHECK_FALSE(report.converged);
    CHECK(report.iterations == 5);
    CHECK_THAT(report.relative_residual, Catch::Matchers::WithinRel((b - k * x).norm() / b.norm(), 1e-6));
  }
  SECTION("the tolerance is below what rounding allows: the backward error decides") {
    const MatrixX m = with_condition(60, 1e14);
    const detail::DenseOperator op(m);
    detail::ConjugateGradientSolver solver(op.size(), {1e-17, 0});
    VectorX x(op.size());
    const VectorX b = VectorX::Ones(op.size());
    const SolveReport report = solver.solve_into(op, b, x);
    CHECK(x.allFinite());
    const double backward = (b - m * x).norm() / (m.norm() * x.norm() + b.norm());
    CHECK(report.converged == (backward <= 1e-12));
  }
  SECTION("an indefinite matrix") {
    MatrixX m = full(sphere_stiffness(1));
    m.diagonal().array() -= 0.5 * m.diagonal().maxCoeff();
    REQUIRE(Eigen::LLT<MatrixX>(m).info() != Eigen::Success);
    const detail::DenseOperator op(m);
    detail::ConjugateGradientSolver solver(op.size());
    VectorX x(op.size());
    const VectorX b = VectorX::Ones(op.size());
    const SolveReport report = solver.solve_into(op, b, x);
    CHECK((!report.converged || (b - m * x).norm() <= 1e-11 * b.norm()));
  }
  SECTION("NaN in the load or in the matrix") {
    MatrixX m = full(sphere_stiffness(1));
    detail::ConjugateGradientSolver solver(m.rows());
    VectorX b = VectorX::Ones(m.rows()), x(m.rows());
    b[3] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(solver.solve_into(detail::DenseOperator(m), b, x).converged);
    m(4, 2) = m(2, 4) = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(solver.solve_into(detail::DenseOperator(m), VectorX::Ones(m.rows()), x).converged);
    b[3] = infinity;
    CHECK_FALSE(solver.solve_into(detail::DenseOperator(full(sphere_stiffness(1))), b, x).converged);
  }
}

TEST_CASE("a converged residual is the true one, not the recursive one", "[linear][cg]") {
  const MatrixX m = with_condition(80, 1e4);
  const detail::DenseOperator op(m);
  detail::ConjugateGradientSolver solver(op.size(), {1e-10, 2000});
  VectorX x(op.size());
  const VectorX b = VectorX::Ones(op.size());
  const SolveReport report = solver.solve_into(op, b, x);
  REQUIRE(report.converged);
  CHECK((b - m * x).norm() <= 1.01e-10 * b.norm());
}

TEST_CASE("the condition estimate is within a factor of ten", "[linear][condition]") {
  for (double condition : {1.0, 1e3, 1e6, 1e10, 1e13}) {
    const MatrixX m = condition == 1.0 ? MatrixX(MatrixX::Identity(40, 40)) : with_condition(40, condition);
    DenseCholesky solver(m, {});
    const double estimate = m.cwiseAbs().colwise().sum().maxCoeff() * detail::inverse_norm_estimate(solver);
    const double exact = exact_condition(m);
    INFO(condition << ": exact " << exact << ", estimated " << estimate);
    CHECK(estimate <= 1.01 * exact * (1.0 + 1e-15 * exact));  // a lower bound up to rounding
    CHECK(estimate >= 0.1 * exact * (1.0 - 1e-15 * exact));
  }
  for (double condition : {1e3, 1e6, 1e10}) {
    const MatrixX m = with_condition(40, condition);
    DenseCholesky solver(m, {});
    const double estimate = detail::condition_by_iteration(detail::DenseOperator(m), solver);
    INFO(condition << ": estimated " << estimate << " by iteration");
    CHECK(estimate <= 1.01 * condition);
    CHECK(estimate >= 0.1 * condition);
  }
  const SparseMatrix lower = sphere_stiffness(2);
  const MatrixX k = full(lower);
  SparseCholesky solver(lower, {});
  const double estimate = k.cwiseAbs().colwise().sum().maxCoeff() * detail::inverse_norm_estimate(solver);
  const double ratio = estimate / exact_condition(k);
  CHECK(ratio <= 1.0 + 1e-9);
  CHECK(ratio >= 0.1);
}

TEST_CASE("the probe error equals the error", "[linear][condition]") {
  const MatrixX k = full(sphere_stiffness(2));
  DenseCholesky good(k, {});
  CHECK(probe_error(op_of(k), good) <= 1e-12);
  DenseCholesky other(1.001 * k, {});  // a solver of another system
  CHECK_THAT(probe_error(op_of(k), other), Catch::Matchers::WithinRel(1e-3, 2e-3));
  struct Broken {
    Index n;
    Index size() const { return n; }
    SolveReport solve_into(const VectorX&, VectorX& x) noexcept {
      x.setConstant(std::numeric_limits<double>::quiet_NaN());
      return {};
    }
  } broken{k.rows()};
  CHECK(probe_error(op_of(k), broken) == infinity);
  CHECK_FALSE(std::isfinite(detail::inverse_norm_estimate(broken)));
}
