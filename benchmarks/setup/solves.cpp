// Solves with an existing factor: one right-hand side compared with reading the factor twice, blocks in GFLOP/s.
#include "../common/bodies.hpp"
#include "setup.hpp"

namespace setup {
namespace {

using namespace palpate;

void measure_single(Session& session, const bench::System& system, SparseCholesky& solver, int n) {
  const double factor = 8.0 * static_cast<double>(solver.factor_nonzeros());
  const VectorX b = bench::random_matrix(system.lower.rows(), 1);
  VectorX x(b.size());
  std::vector<double> times, bandwidths;
  for (int round = 0; round < 5; ++round) {  // alternately, each long enough to have its data in cache
    times.push_back(bench::median_seconds([&] { solver.solve_into(b, x); }, {.seconds = 0.2, .least = 3, .most = 9}));
    bandwidths.push_back(bench::read_bandwidth(factor, {.seconds = 0.2, .least = 3, .most = 9}));
  }
  const double seconds = bench::percentile(times, 0.5), bandwidth = bench::percentile(bandwidths, 0.5);
  const double rate = 2.0 * factor / seconds;
  session.rows.add({.target = "e",
                    .what = at_size("one right-hand side / reading the factor", n),
                    .figure = bench::gigabytes_per_second(rate) + " (" + bench::milliseconds(seconds) + ")",
                    .baseline = bench::gigabytes_per_second(bandwidth) + " at " + bench::megabytes(factor),
                    .ratio = rate / bandwidth,
                    .bound = bench::at_least(0.85),
                    .error = error_over(system.residual(x, b), 1e-10, "residual")});
}

void measure_block(Session& session, const bench::System& system, const SparseCholesky& solver, int n, int columns) {
  const MatrixX b = bench::random_matrix(system.lower.rows(), columns);
  MatrixX x;
  const double seconds = bench::median_seconds([&] { x = solver.solve(b); });
  const double rate = 4.0 * static_cast<double>(solver.factor_nonzeros()) * columns / seconds;
  const std::string what = std::to_string(columns) + " right-hand sides";
  session.rows.add({.target = "e",
                    .what = at_size(what.c_str(), n),
                    .figure = bench::gigaflops(rate) + " (" + bench::milliseconds(seconds) + ")",
                    .baseline = "15 GFLOP/s",
                    .ratio = rate / 15e9,
                    .bound = bench::at_least(1.0),
                    .error = error_over(system.residual(x.col(columns - 1), b.col(columns - 1)), 1e-10, "residual")});
}

}  // namespace

void measure_solves(Session& session) {
  for (const int n : {10, 16, 24}) {
    const bench::System system(bench::standard_block(n));
    SparseCholesky solver(detail::CholeskyAnalysis(system.lower, system.layout), system.lower, SetupLimits{});
    measure_single(session, system, solver, n);
    if (n >= 16)
      for (const int columns : {16, 64}) measure_block(session, system, solver, n, columns);
  }
}

}  // namespace setup
