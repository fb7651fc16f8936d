// The direct solver against dense references, for every code path.
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/solver_laws.hpp>

#include <thread>

#include "linear/sparse_cases.hpp"

using namespace test;

namespace {

SparseCholesky factored(const SparseCase& c) {
  return {detail::CholeskyAnalysis(c.lower, c.layout), c.lower, {}};
}

/// Backward error |b - K x| / (|K| |x| + |b|) in maximum norms.
double residual(const SparseMatrix& lower, const VectorX& b, const VectorX& x) {
  const MatrixX k = full(lower);
  return largest(b - k * x) / (k.cwiseAbs().rowwise().sum().maxCoeff() * largest(x) + largest(b));
}

/// Every third dof, not in order.
std::vector<Index> some_dofs(Index n) {
  std::vector<Index> kept;
  for (Index i = 0; i < n; i += 3) kept.push_back(n - 1 - i);
  return kept;
}

}  // namespace

TEST_CASE("the sparse solver is accurate to rounding", "[linear][sparse_cholesky]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    SparseCholesky solver = factored(c);
    REQUIRE(solver.size() == c.lower.rows());
    if (solver.size() == 0) continue;
    VectorX x(solver.size());
    for (std::uint64_t seed : {1u, 2u}) {
      const VectorX b = random_vector(solver.size(), seed);
      CHECK(solver.solve_into(b, x).converged);
      CHECK(residual(c.lower, b, x) <= 1e-15);
    }
    VectorX in_place = random_vector(solver.size(), 2);
    solver.solve_into(in_place, in_place);
    CHECK(in_place == x);
  }
}

TEST_CASE("the sparse solver passes the law suite of solvers", "[linear][sparse_cholesky][laws]") {
  const SparseCase c = sphere_case(3);
  const MatrixX k = full(c.lower);
  SparseCholesky solver = factored(c);
  CHECK(testing::describe(testing::solver_laws(op_of(k), solver, {1e-13, true})) == "");
  for (double unit : {1e-12, 1e12}) {
    SparseCholesky scaled(SparseMatrix(unit * c.lower), {});
    const VectorX b = random_vector(k.rows(), 9), truth = exact_solution(unit * k, b);
    VectorX x(k.rows());
    scaled.solve_into(b, x);
    CHECK((x - truth).norm() <= 1e-13 * exact_condition(k) * truth.norm());
  }
}

TEST_CASE("a large front is factorised in panels", "[linear][sparse_cholesky]") {
  const Index n = 700;  // several panels, and more rows than the unpacked kernels take
  const SparseMatrix lower = lower_half(with_condition(n, 1e4));
  SparseCholesky solver(lower, {});
  CHECK(solver.analysis().front_count() == 1);
  CHECK(solver.factor_nonzeros() == n * (n + 1) / 2);
  const VectorX b = random_vector(n, 4);
  VectorX x(n);
  solver.solve_into(b, x);
  CHECK(residual(lower, b, x) <= 1e-15);
  const MatrixX many = solver.solve(MatrixX(MatrixX::Identity(n, 40)));
  CHECK(largest(full(lower) * many - MatrixX::Identity(n, 40)) <= 1e-11);
  DofLayout layout;  // and with rows below it
  for (Index i = 0; i < 250; ++i) layout.kept.push_back(i);
  MatrixX schur;
  SparseCholesky::interior(detail::CholeskyAnalysis(lower, layout), lower, schur, {});
  const MatrixX k = full(lower);
  const MatrixX expected =
      k.topLeftCorner(250, 250) -
      k.topRightCorner(250, 450) * k.bottomRightCorner(450, 450).llt().solve(k.bottomLeftCorner(450, 250));
  CHECK(largest(schur - expected) <= 1e-12 * largest(k));
}

TEST_CASE("kept dofs: the Schur complement is exact", "[linear][sparse_cholesky][schur]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const Index n = c.lower.rows();
    DofLayout layout = c.layout;
    layout.kept = some_dofs(n);
    const detail::CholeskyAnalysis analysis(c.lower, layout);
    MatrixX schur;
    SparseCholesky interior = SparseCholesky::interior(analysis, c.lower, schur, {});
    const auto k = static_cast<Index>(layout.kept.size());
    REQUIRE(schur.rows() == k);
    CHECK(interior.kept() == k);
    if (n == 0) continue;
    const MatrixX inverse = full(c.lower).llt().solve(MatrixX::Identity(n, n));
    const MatrixX expected = inverse(layout.kept, layout.kept).llt().solve(MatrixX::Identity(k, k));
    CHECK(largest(schur - expected) <= 1e-12 * largest(expected));
    CHECK(schur == schur.transpose());

    const VectorX b = random_vector(n, 5);
    VectorX kept_load(k), x(n), direct(n);
    interior.eliminate_into(b, kept_load);
    const VectorX kept_answer = schur.llt().solve(kept_load);
    interior.recover_into(kept_answer, x);
    CHECK(residual(c.lower, b, x) <= 1e-14);
    for (Index i = 0; i < k; ++i) CHECK(x[layout.kept[static_cast<std::size_t>(i)]] == kept_answer[i]);
    SparseCholesky(analysis, c.lower, {}).solve_into(b, direct);
    CHECK(residual(c.lower, b, direct) <= 1e-14);

    // The interior factor alone constrains the kept dofs to zero.
    interior.solve_into(b, x);
    const VectorX constrained = interior.solve(b);
    CHECK(largest(x - constrained) <= 1e-13 * (largest(x) + 1e-300));
    for (Index dof : layout.kept) CHECK(x[dof] == 0.0);
  }
}

TEST_CASE("solves for a few loaded and wanted dofs equal full solves", "[linear][sparse_cholesky][path]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const Index n = c.lower.rows();
    if (n < 10) continue;
    SparseCholesky solver = factored(c);
    testing::Random random(17);
    for (int trial = 0; trial < 5; ++trial) {
      std::vector<Index> loaded, wanted;
      std::vector<double> loads;
      VectorX b = VectorX::Zero(n), x(n);
      for (int i = 0; i < 4; ++i) {
        loaded.push_back(static_cast<Index>(random.uniform(0.0, static_cast<double>(n))));
        wanted.push_back(static_cast<Index>(random.uniform(0.0, static_cast<double>(n))));
        loads.push_back(random.uniform(-1.0, 1.0));
        b[loaded.back()] += loads.back();
      }
      std::vector<double> answer(wanted.size());
      solver.solve_path_into(loaded, loads, wanted, answer);
      solver.solve_into(b, x);
      for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(answer[i] == x[wanted[i]]);
      solver.solve_path_into(loaded, loads, wanted, answer);
      for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(answer[i] == x[wanted[i]]);
    }
  }
}

TEST_CASE("a block of right-hand sides equals single solves (sparse)", "[linear][sparse_cholesky]") {
  for (const SparseCase& c : sparse_cases()) {
    INFO(c.name);
    const Index n = c.lower.rows();
    SparseCholesky solver = factored(c);
    for (Index columns : {Index{0}, Index{1}, Index{7}, Index{17}, Index{53}}) {
      MatrixX b(n, columns);
      for (Index j = 0; j < columns; ++j) b.col(j) = random_vector(n, static_cast<std::uint64_t>(j));
      const MatrixX x = solver.solve(b);
      REQUIRE(x.cols() == columns);
      VectorX one(n);
      for (Index j = 0; j < columns && n > 0; ++j) {
        solver.solve_into(b.col(j), one);
        CHECK(largest(x.col(j) - one) <= 1e-12 * largest(one));
        CHECK(residual(c.lower, b.col(j), x.col(j)) <= 1e-15);
      }
    }
  }
}

TEST_CASE("new values can be factorised on an analysed pattern", "[linear][sparse_cholesky]") {
  const SparseCase c = sphere_case(3);
  const detail::CholeskyAnalysis analysis(c.lower, c.layout);
  SparseMatrix other = c.lower;
  for (Index j = 0; j < other.cols(); ++j) other.coeffRef(j, j) *= 1.5;
  const VectorX b = random_vector(other.rows(), 8);
  VectorX reused(b.size()), fresh(b.size()), again(b.size());
  SparseCholesky(analysis, c.lower, {}).solve_into(b, again);
  SparseCholesky(analysis, other, {}).solve_into(b, reused);
  SparseCholesky(detail::CholeskyAnalysis(other, c.layout), other, {}).solve_into(b, fresh);
  CHECK(reused == fresh);  // to the last bit, and in every run
  CHECK(reused != again);
  CHECK(analysis.fits(other));
  const SparseMatrix wrong = sphere_stiffness(2);
  CHECK_FALSE(analysis.fits(wrong));
  CHECK_REFUSED(SetupErrorKind::bad_argument, SparseCholesky(analysis, wrong, {}));
  CHECK_FALSE(detail::CholeskyAnalysis().fits(wrong));
  CHECK_REFUSED(SetupErrorKind::bad_argument, SparseCholesky(detail::CholeskyAnalysis(), wrong, {}));
}

TEST_CASE("sparse Cholesky: copies solve simultaneously", "[linear][sparse_cholesky][threads]") {
  const SparseCase c = sphere_case(3);
  SparseCholesky original = factored(c);
  std::vector<SparseCholesky> copies(3, original);
  std::vector<VectorX> expected(3, VectorX(original.size())), found = expected;
  for (std::size_t i = 0; i < 3; ++i) original.solve_into(random_vector(original.size(), i), expected[i]);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 3; ++i)
    threads.emplace_back([&, i] {
      const VectorX b = random_vector(copies[i].size(), i);
      for (int again = 0; again < 50; ++again) copies[i].solve_into(b, found[i]);
    });
  for (std::thread& t : threads) t.join();
  for (std::size_t i = 0; i < 3; ++i) CHECK(found[i] == expected[i]);
}

TEST_CASE("solves do not allocate", "[linear][sparse_cholesky][realtime]") {
  const SparseCase c = sphere_case(3);
  const Index n = c.lower.rows();
  DofLayout layout = c.layout;
  layout.kept = some_dofs(n);
  MatrixX schur;
  SparseCholesky solver = factored(c);
  SparseCholesky interior = SparseCholesky::interior(detail::CholeskyAnalysis(c.lower, layout), c.lower, schur, {});
  const VectorX b = random_vector(n, 6);
  VectorX x(n), load(interior.kept());
  const std::vector<Index> loaded{3, 77}, wanted{5, 6};
  const std::vector<double> loads{1.0, -1.0};
  std::vector<double> answer(2);
  testing::AllocationScope scope;
  solver.solve_into(b, x);
  solver.solve_path_into(loaded, loads, wanted, answer);
  interior.eliminate_into(b, load);
  interior.recover_into(load, x);
  const std::uint64_t allocations = scope.allocations();
  CHECK(allocations == 0);
}

TEST_CASE("limits of a factorisation", "[linear][sparse_cholesky]") {
  const SparseCase c = sphere_case(4);
  const detail::CholeskyAnalysis analysis(c.lower, c.layout);
  SetupLimits limits;
  limits.memory = static_cast<std::size_t>(analysis.peak_bytes()) - 1;
  CHECK_REFUSED(SetupErrorKind::too_large, SparseCholesky(analysis, c.lower, limits));
  limits.memory += 1;
  CHECK_NOTHROW(SparseCholesky(analysis, c.lower, limits));
  DofLayout layout = c.layout;
  layout.kept = some_dofs(c.lower.rows());
  const detail::CholeskyAnalysis with_kept(c.lower, layout);
  MatrixX schur;
  limits.memory = static_cast<std::size_t>(with_kept.interior_peak_bytes()) - 1;
  CHECK_REFUSED(SetupErrorKind::too_large, SparseCholesky::interior(with_kept, c.lower, schur, limits));
  CHECK(schur.size() == 0);
  int calls = 0;
  double last = 0.0;
  limits.progress = [&](const Progress& p) {
    CHECK(p.fraction >= last);
    last = p.fraction;
    return ++calls < 6;
  };
  CHECK_REFUSED(SetupErrorKind::cancelled, SparseCholesky(analysis, c.lower, limits));
  CHECK(calls == 6);
  SparseCholesky solver(analysis, c.lower, {});
  CHECK(static_cast<double>(solver.bytes()) <= 1.01 * analysis.factor_bytes() + 1024.0);
  CHECK(static_cast<double>(solver.factor_nonzeros()) * sizeof(double) <= analysis.factor_bytes());
}
