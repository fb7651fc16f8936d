// Analysis and numeric factorisation compared with CHOLMOD, with Eigen's SimplicialLDLT, and with the rate of gemm.
#include "../common/bodies.hpp"
#include "cholmod.hpp"
#include "setup.hpp"

#include <palpate/io/read_mesh.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/Cholesky>

#include <optional>
#include <tuple>

namespace setup {
namespace {

using namespace palpate;
using bench::Cholmod;

/// Figures of one matrix; times are medians [s].
struct Times {
  double analysis = 0.0, numeric = 0.0, cholmod = bench::unknown, cholmod_analysis = bench::unknown;
  double flops = 0.0, cholmod_flops = bench::unknown;
  std::string error;
};

Times factorise(const bench::System& system) {
  Times t;
  detail::CholeskyAnalysis analysis;
  t.analysis = bench::median_seconds([&] { analysis = detail::CholeskyAnalysis(system.lower, system.layout); },
                                     {.seconds = 0.7, .least = 3, .most = 15});
  t.flops = analysis.flops();
  SparseCholesky solver;
  const auto ours = [&] {
    solver = {};
    solver = SparseCholesky(analysis, system.lower, SetupLimits{});
  };
  const VectorX b = bench::random_matrix(system.lower.rows(), 1);
  if (Cholmod::available()) {
    Cholmod cholmod(system.lower);
    t.cholmod_analysis = cholmod.analysis_seconds();
    cholmod.factorise();  // the first call allocates
    std::tie(t.numeric, t.cholmod) = bench::medians_in_turns(ours, [&] { cholmod.factorise(); });
    t.cholmod_flops = cholmod.flops();
    t.error = error_over(system.residual(cholmod.solve(b), b), 1e-10, "CHOLMOD's residual");
  } else {
    t.numeric = bench::median_seconds(ours);
  }
  VectorX x(b.size());
  solver.solve_into(b, x);
  if (t.error.empty()) t.error = error_over(system.residual(x, b), 1e-10, "residual");
  return t;
}

void add_cholmod_row(Session& session, const Times& t, const std::string& where, bench::Bound bound) {
  if (!Cholmod::available())
    return session.rows.skip("a", "numeric factorisation / CHOLMOD" + where, "libsuitesparse-dev is not installed");
  session.rows.add({.target = "a",
                    .what = "numeric factorisation / CHOLMOD" + where,
                    .figure = bench::milliseconds(t.numeric),
                    .baseline = bench::milliseconds(t.cholmod),
                    .ratio = t.numeric / t.cholmod,
                    .bound = bound,
                    .error = t.error});
  session.rows.add({.target = "a",
                    .what = "with analysis / CHOLMOD with METIS" + where,
                    .figure = bench::milliseconds(t.numeric + t.analysis),
                    .baseline = bench::milliseconds(t.cholmod + t.cholmod_analysis),
                    .ratio = (t.numeric + t.analysis) / (t.cholmod + t.cholmod_analysis),
                    .bound = {},
                    .error = ""});
}

/// Analysis and numeric factorisation together, for both solvers. Runs once, as it takes seconds.
void add_simplicial_row(Session& session, const bench::System& system, const Times& t, int n) {
  std::optional<Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>> ldlt;
  const double theirs = bench::seconds_of([&] { ldlt.emplace(system.lower); });
  const VectorX b = bench::random_matrix(system.lower.rows(), 1), x = ldlt->solve(b);
  session.rows.add({.target = "b",
                    .what = at_size("SimplicialLDLT / ours, with analysis", n),
                    .figure = bench::milliseconds(t.analysis + t.numeric),
                    .baseline = bench::milliseconds(theirs),
                    .ratio = theirs / (t.analysis + t.numeric),
                    .bound = n == 16 ? bench::at_least(20.0) : bench::Bound{},
                    .error = error_over(system.residual(x, b), 1e-10, "its residual")});
}

}  // namespace

void measure_factorisation(Session& session) {
  std::vector<int> sizes{10, 16, 24};
  if (session.long_run) sizes.push_back(32);
  for (const int n : sizes) {
    const bench::System system(bench::standard_block(n));
    const Times t = factorise(system);
    const double gemm = bench::gemm_rate();
    const std::string where = at_size("", n);
    add_cholmod_row(session, t, where, bench::at_most(n < 32 ? 1.0 : 1.3));
    if (n <= 16) add_simplicial_row(session, system, t, n);
    session.rows.add({.target = "c",
                      .what = "analysis / numeric factorisation" + where,
                      .figure = bench::milliseconds(t.analysis),
                      .baseline = bench::milliseconds(t.numeric),
                      .ratio = t.analysis / t.numeric,
                      .bound = bench::at_most(0.15),
                      .error = ""});
    session.rows.add({.target = "gemm",
                      .what = "rate of the factorisation / Eigen gemm 512" + where,
                      .figure = bench::gigaflops(t.flops / t.numeric),
                      .baseline = bench::gigaflops(gemm),
                      .ratio = t.flops / t.numeric / gemm,
                      .bound = n < 16 ? bench::Bound{} : bench::at_least(0.45),
                      .error = ""});
  }
  if (!session.long_run) session.rows.skip("a", "numeric factorisation / CHOLMOD, n = 32", "with --long only");
}

void measure_irregular(Session& session, const char* organ_file) {
  const auto measure = [&](const bench::SupportedBody& constrained, const std::string& name) {
    const bench::System system(constrained);
    const std::string where = ", " + name + ", " + std::to_string(system.lower.rows()) + " dofs";
    const Times t = factorise(system);
    add_cholmod_row(session, t, where, {});
    if (Cholmod::available())
      session.rows.add({.target = "a",
                        .what = "operations / with METIS" + where,
                        .figure = bench::with_unit(1e-9 * t.flops, "GFLOP"),
                        .baseline = bench::with_unit(1e-9 * t.cholmod_flops, "GFLOP"),
                        .ratio = t.flops / t.cholmod_flops,
                        .bound = bench::at_most(1.1),
                        .error = ""});
  };
  bench::SupportedBody organ{io::read_mesh<Tet4>(organ_file), {}, {}};
  organ.constrained = organ.mesh.find_group("ligament")->nodes;
  organ.touched = organ.mesh.find_group("front")->nodes;
  measure(organ, "organ.msh");
  measure(bench::organ_like(16, 3e-3), "sphere with cavity");
}

}  // namespace setup
