// One deliberately wrong solver for every check of the law suite of linear solvers.
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/testing/solver_laws.hpp>

#include "linear/systems.hpp"

using namespace test;
using testing::solver_laws;
using testing::violates;

namespace {

const MatrixX k = with_condition(20, 100.0);

/// A correct solver with one error.
struct Wrong {
  enum What { nothing, scaled, has_history, touches_load, unsymmetric, offset, not_finite, wrong_size, lies, gives_up };
  What what = nothing;
  DenseCholesky right{k, {}};
  int calls = 0;

  Index size() const { return what == wrong_size ? 3 : right.size(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    right.solve_into(b, x);
    ++calls;
    if (what == scaled) x *= 1.0 + 1e-6;
    if (what == has_history) x[0] += 1e-15 * calls * x.norm();
    if (what == touches_load) const_cast<VectorX&>(b)[0] += 1.0;
    if (what == unsymmetric) x[0] += 1e-3 * b[1];
    if (what == offset) x[0] += 1e-30;
    if (what == not_finite) x[2] = infinity;
    SolveReport report{true, 0, std::numeric_limits<double>::quiet_NaN()};
    if (what == lies) report.relative_residual = 1e-3;
    if (what == gives_up) report.converged = false;
    if (what == scaled) report.iterations = 7;
    return report;
  }
};

testing::Violations laws(Wrong::What what) {
  Wrong solver;
  solver.what = what;
  return solver_laws(op_of(k), solver);
}

}  // namespace

TEST_CASE("the law suite accepts a correct solver", "[testing][linear]") {
  CHECK(testing::describe(laws(Wrong::nothing)) == "");
}

TEST_CASE("every check of the solver law suite can fail", "[testing][linear]") {
  CHECK(violates(laws(Wrong::scaled), "solves"));
  CHECK(violates(laws(Wrong::scaled), "report is truthful"));  // claims convergence, and iterations of a direct solver
  CHECK(violates(laws(Wrong::has_history), "same answer twice"));
  CHECK(violates(laws(Wrong::touches_load), "load is left alone"));
  CHECK(violates(laws(Wrong::unsymmetric), "symmetric"));
  CHECK(violates(laws(Wrong::offset), "zero load gives zero"));
  CHECK(violates(laws(Wrong::not_finite), "finite"));
  CHECK(violates(laws(Wrong::wrong_size), "size"));
  CHECK(violates(laws(Wrong::lies), "report is truthful"));
  CHECK(violates(laws(Wrong::gives_up), "converges"));
  DenseCholesky other(1.0001 * k, {});
  CHECK(violates(testing::accuracy_laws(op_of(k), other, 1e-6), "accurate"));
  CHECK(testing::accuracy_laws(op_of(k), other, 1e-3).empty());
}
