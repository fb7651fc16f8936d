// Conjugate gradients with the incomplete factorisation, compared with the factorisation: memory, preparation, a solve.
#include "../common/bodies.hpp"
#include "setup.hpp"

#include <palpate/linear/conjugate_gradient.hpp>

namespace setup {
namespace {

using namespace palpate;

void inform(Session& session, std::string what, std::string figure, std::string baseline, double ratio) {
  session.rows.add({.target = "w",
                    .what = std::move(what),
                    .figure = std::move(figure),
                    .baseline = std::move(baseline),
                    .ratio = ratio,
                    .bound = {},
                    .error = ""});
}

void measure_block(Session& session, int n) {
  const bench::SupportedBody body = bench::standard_block(n);
  Scene scene;
  scene.fix(body.constrained);
  const auto conditions = resolve_essential(body.mesh, extract_boundary<Tet4>(body.mesh), scene);
  const BlockMatrix k = assemble_stiffness<Tet4>(body.body(), {});
  const VectorX b = bench::random_matrix(conditions.free_count(), 1);
  VectorX x(b.size()), product(b.size());
  detail::FreeStiffness op(k, conditions, {});
  const double prepare =
      bench::median_seconds([&] { op = detail::FreeStiffness(k, conditions, {}); }, {.least = 1, .most = 3});
  detail::ConjugateGradientSolver solver(b.size());
  SolveReport report;
  const double solve = bench::median_seconds([&] { report = solver.solve_into(op, b, x); }, {.least = 1, .most = 3});
  op.apply(x, product);
  const double memory = static_cast<double>(k.bytes() + op.bytes() + solver.bytes());

  const bench::System system(body);
  const detail::CholeskyAnalysis analysis(system.lower, system.layout);
  session.rows.add({.target = "w",
                    .what = at_size("memory of conjugate gradients / peak of the factorisation", n),
                    .figure = bench::megabytes(memory),
                    .baseline = bench::megabytes(analysis.peak_bytes()),
                    .ratio = memory / analysis.peak_bytes(),
                    .bound = bench::at_most(0.5),
                    .error = error_over((b - product).norm() / b.norm(), 1e-11, "residual")});
  const double factorise = bench::median_seconds(
      [&] {
        const SparseCholesky factor(detail::CholeskyAnalysis(system.lower, system.layout), system.lower, SetupLimits{});
      },
      {.least = 1, .most = 1});
  inform(session, at_size("preparing conjugate gradients / analysing and factorising", n), bench::milliseconds(prepare),
         bench::milliseconds(factorise), prepare / factorise);
  inform(session, at_size("one solve of conjugate gradients / analysing and factorising", n),
         bench::milliseconds(solve) + ", " + std::to_string(report.iterations) + " iterations",
         bench::milliseconds(factorise), solve / factorise);
}

}  // namespace

void measure_iterative(Session& session) {
  for (const int n : {16, 26}) measure_block(session, n);
  if (session.long_run) measure_block(session, 55);  // a million tetrahedra
}

}  // namespace setup
