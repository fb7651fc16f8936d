// Factorisation and whole set-up by one and by two threads, compared with CHOLMOD on the same threads and with Eigen.
// Wall time.
#include "../common/bodies.hpp"
#include "../common/touching.hpp"
#include "cholmod.hpp"
#include "setup.hpp"
#include "work_and_span.hpp"

#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <Eigen/SparseCholesky>

#include <array>
#include <chrono>
#include <cstring>
#include <memory>

#if defined(__linux__)
#include <unistd.h>
#endif

namespace setup {
namespace {

using namespace palpate;
using bench::Cholmod;

template <class Work>
double wall_seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Medians of three of work(1) and work(2), in turns, after a turn without measurement. Work of more than a minute is
/// done once. `after` is not measured.
template <class Work, class After>
std::array<double, 2> in_turns(Work&& work, After&& after) {
  constexpr double long_work = 60.0;
  const bench::KeepFreedMemory keep;
  std::array<std::vector<double>, 2> times;
  for (int turn = 0; turn < 4; ++turn) {
    for (const int threads : {1, 2}) {
      times[static_cast<std::size_t>(threads) - 1].push_back(wall_seconds([&] { work(threads); }));
      after(threads);
    }
    if (times[0].front() > long_work) break;
    if (turn == 0) times = {};
  }
  return {bench::percentile(std::move(times[0]), 0.5), bench::percentile(std::move(times[1]), 0.5)};
}

std::string same_bits(const VectorX& a, const VectorX& b) {
  const auto bytes = sizeof(double) * static_cast<std::size_t>(a.size());
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), bytes) == 0 ? "" : "the bits depend on the threads";
}

void inform(Session& session, std::string what, std::string figure, std::string baseline = "") {
  session.rows.add({.target = "v",
                    .what = std::move(what),
                    .figure = std::move(figure),
                    .baseline = std::move(baseline),
                    .bound = {},
                    .error = ""});
}

/// Threads on which fronts are timed, each with a copy of the system: two if there is memory for both; one where the
/// memory of the machine is not known.
int timed_threads([[maybe_unused]] const detail::CholeskyAnalysis& analysis) {
#if defined(__linux__)
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (2.0 * analysis.peak_bytes(1) < 0.7 * memory) return 2;
#endif
  return 1;
}

/// What more threads would give, and what limits them; for two threads compared with the measured time.
void predict_threads(Session& session, const detail::CholeskyAnalysis& analysis, const bench::System& system,
                     double measured, const std::string& where) {
  const int timed = timed_threads(analysis);
  const std::vector<bench::FrontTime> times = bench::time_fronts(analysis, system.lower, timed);
  const double one = bench::predict(analysis, times, 1).seconds;
  const double two = bench::predict(analysis, times, 2).seconds;
  session.rows.add({.target = "v",
                    .what = "two threads, predicted by work and span / measured" + where,
                    .figure = bench::milliseconds(two) + ", fronts timed on " + std::to_string(timed),
                    .baseline = bench::milliseconds(measured),
                    .ratio = std::max(two / measured, measured / two),
                    .bound = bench::at_most(1.1),
                    .error = ""});
  for (const int threads : {4, 8, 16, 1000}) {
    const bench::Predicted p = bench::predict(analysis, times, threads);
    inform(session, "predicted with " + std::to_string(threads) + " threads" + where,
           bench::milliseconds(p.seconds) + ", speed-up " + bench::with_unit(one / p.seconds, ""),
           "one front at a time " + bench::with_unit(100.0 * p.one_task, "%") + ", threads idle beside serial parts " +
               bench::with_unit(100.0 * p.not_shared, "%"));
  }
}

/// Operations, entries and time per level of the tree. By theory, in three dimensions each level of bisections has half
/// of the operations of the one above it and 0.79 of its entries.
void describe_levels(Session& session, const detail::CholeskyAnalysis& analysis, const std::string& where) {
  const auto& fronts = analysis.tree().fronts;
  std::vector<int> depth(static_cast<std::size_t>(fronts.size()), 0);
  std::vector<double> flops, entries;
  for (Index f = fronts.size() - 1; f >= 0; --f) {
    int& d = depth[static_cast<std::size_t>(f)];
    if (fronts[f].parent >= 0) d = depth[static_cast<std::size_t>(fronts[f].parent)] + 1;
    flops.resize(std::max(flops.size(), static_cast<std::size_t>(d) + 1), 0.0);
    entries.resize(flops.size(), 0.0);
    flops[static_cast<std::size_t>(d)] += fronts[f].flops();
    entries[static_cast<std::size_t>(d)] += fronts[f].nonzeros();
  }
  std::string operations, fill;
  for (std::size_t d = 0; d < std::min<std::size_t>(8, flops.size()); ++d) {
    operations += (d == 0 ? "" : " ") + bench::with_unit(100.0 * flops[d] / analysis.flops(), "", 2);
    fill += (d == 0 ? "" : " ") + bench::with_unit(100.0 * entries[d] / analysis.nonzeros(), "", 2);
  }
  inform(session, "levels of the tree from the root, % of the operations; of the entries" + where, operations, fill);
}

/// Growth from the body before, as an exponent of the number of elements. Nested dissection in three dimensions: 2 for
/// operations, 4/3 for entries.
void describe_growth(Session& session, const bench::SupportedBody& body, const detail::CholeskyAnalysis& analysis,
                     const std::string& where) {
  struct Size {
    double elements, flops, entries;
  };
  static Size before{};
  const Size now{static_cast<double>(body.mesh.element_count()), analysis.flops(), analysis.nonzeros()};
  inform(session, "operations; entries of the factor" + where, bench::with_unit(1e-9 * now.flops, "GFLOP"),
         bench::megabytes(8.0 * now.entries));
  if (before.elements > 0.0 && now.elements > before.elements) {
    const double size = std::log(now.elements / before.elements);
    inform(session, "exponent of growth of the operations (theory 2); of the entries (4/3)" + where,
           bench::with_unit(std::log(now.flops / before.flops) / size, ""),
           bench::with_unit(std::log(now.entries / before.entries) / size, ""));
  }
  before = now;
}

void compare_with_eigen(Session& session, const bench::System& system, double two_threads, const std::string& where) {
  using Solver = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>;
  constexpr Index soon = 15'000, long_run = 70'000;  // dofs: seconds and a minute
  const std::string what = "two threads / Eigen's SimplicialLDLT, one thread" + where;
  if (system.lower.rows() > (session.long_run ? long_run : soon))
    return session.rows.skip("v", what, "it would take too long");
  Solver solver;
  solver.analyzePattern(system.lower);
  const double theirs = wall_seconds([&] { solver.factorize(system.lower); });
  const VectorX b = bench::random_matrix(system.lower.rows(), 1);
  session.rows.add({.target = "v",
                    .what = what,
                    .figure = bench::milliseconds(two_threads),
                    .baseline = bench::milliseconds(theirs) + ", factor of " +
                                bench::megabytes((sizeof(double) + sizeof(Index)) *
                                                 static_cast<double>(solver.matrixL().nestedExpression().nonZeros())),
                    .ratio = two_threads / theirs,
                    .bound = {},
                    .error = error_over(system.residual(solver.solve(b), b), 1e-10, "Eigen's residual")});
}

void factorise(Session& session, const bench::SupportedBody& body, const std::string& where) {
  const bench::System system(body);
  const detail::CholeskyAnalysis analysis(system.lower, system.layout);
  const VectorX b = bench::random_matrix(system.lower.rows(), 1);
  std::array<VectorX, 2> x{VectorX(b.size()), VectorX(b.size())};
  SparseCholesky solver;
  const auto times = in_turns(
      [&](int threads) {
        solver = {};
        SetupLimits limits;
        limits.threads = threads;
        solver = SparseCholesky(analysis, system.lower, limits);
      },
      [&](int threads) { solver.solve_into(b, x[static_cast<std::size_t>(threads) - 1]); });
  std::string error = same_bits(x[0], x[1]);
  if (error.empty()) error = error_over(system.residual(x[0], b), 1e-10, "residual");
  session.rows.add({.target = "v",
                    .what = "numeric factorisation, one thread / two" + where,
                    .figure = bench::milliseconds(times[1]),
                    .baseline = bench::milliseconds(times[0]),
                    .ratio = times[0] / times[1],
                    .bound = body.mesh.element_count() > 90000 ? bench::at_least(1.7) : bench::Bound{},
                    .error = error});
  solver = {};
  compare_with_eigen(session, system, times[1], where);
  predict_threads(session, analysis, system, times[1], where);
  describe_levels(session, analysis, where);
  describe_growth(session, body, analysis, where);
  if (!Cholmod::available())
    return session.rows.skip("v", "two threads / CHOLMOD's" + where, "libsuitesparse-dev is not installed");
  Cholmod cholmod(system.lower);
  const auto theirs = in_turns(
      [&](int threads) {
        Cholmod::set_threads(threads);
        cholmod.factorise();
      },
      [](int) {});
  Cholmod::set_threads(1);
  inform(session, "peak memory with two threads, CHOLMOD's" + where, bench::megabytes(analysis.peak_bytes(2)),
         bench::megabytes(cholmod.peak_bytes()));
  for (const std::size_t i : {0, 1})
    session.rows.add({.target = "v",
                      .what = (i == 0 ? "one thread / CHOLMOD's" : "two threads / CHOLMOD's") + where,
                      .figure = bench::milliseconds(times[i]),
                      .baseline = bench::milliseconds(theirs[i]),
                      .ratio = times[i] / theirs[i],
                      .bound = bench::at_most(1.0),
                      .error = ""});
}

void set_up(Session& session, const bench::SupportedBody& body, const std::string& where) {
  using Model = bench::Touching::Model;
  std::unique_ptr<Model> model;
  const std::vector<VertexForce> press{{0, ModelVector(Vector3(0.0, 0.0, -1.0))}};
  std::array<VectorX, 2> displacement;
  const auto times = in_turns(
      [&](int threads) {
        model.reset();
        SetupOptions options;
        options.threads = threads;
        model = std::make_unique<Model>(body.mesh, body.scene(), bench::tissue, options);
      },
      [&](int threads) { model->displacement_with(press, displacement[static_cast<std::size_t>(threads) - 1]); });
  session.rows.add({.target = "v",
                    .what = "whole set-up, one thread / two" + where,
                    .figure = bench::milliseconds(times[1]),
                    .baseline = bench::milliseconds(times[0]),
                    .ratio = times[0] / times[1],
                    .bound = body.mesh.element_count() > 100000 ? bench::at_least(1.7) : bench::Bound{},
                    .error = same_bits(displacement[0], displacement[1])});
}

}  // namespace

void measure_threads(Session& session) {
  std::vector<int> cells{16, 26}, layers{11, 17};
  if (session.long_run) {
    cells.insert(cells.end(), {36, 55});
    layers.insert(layers.end(), {25, 38});
  }
  const auto measure = [&](const bench::SupportedBody& body, const std::string& what) {
    const std::string where = ", " + what + std::to_string(body.mesh.element_count()) + " tets";
    factorise(session, body, where);
    set_up(session, body, where);
  };
  for (const int n : cells) measure(bench::touch_block(n, n), "block of ");
  for (const int n : layers) measure(bench::touch_organ(n), "organ-like, ");
}

}  // namespace setup
