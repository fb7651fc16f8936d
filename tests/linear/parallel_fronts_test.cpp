// Factorisation by several threads.
#include "catch.hpp"

#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/linear/detail/front_tasks.hpp>
#include <palpate/linear/detail/front_tree.hpp>

#include <atomic>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include "refused.hpp"
#include "linear/large_case.hpp"

using namespace palpate;
using namespace test;

namespace {

std::vector<Index> first_dofs(Index count) {
  std::vector<Index> kept;
  for (Index i = 0; i < count; ++i) kept.push_back(i);
  return kept;
}

/// A solution and the Schur complement: they depend on every number of the factor.
std::vector<VectorX> results_with(const SetupThreads& threads) {
  const SparseCase& c = large_case();
  SetupLimits limits;
  limits.threads = threads;
  SparseCholesky whole(detail::CholeskyAnalysis(c.lower, c.layout), c.lower, limits);
  DofLayout layout = c.layout;
  layout.kept = first_dofs(90);
  MatrixX schur;
  SparseCholesky interior = SparseCholesky::interior(detail::CholeskyAnalysis(c.lower, layout), c.lower, schur, limits);
  VectorX b(c.lower.rows()), x(c.lower.rows());
  for (Index i = 0; i < b.size(); ++i) b[i] = std::sin(static_cast<double>(i));
  whole.solve_into(b, x);
  VectorX condensed(interior.kept());
  interior.eliminate_into(b, condensed);
  return {x, condensed, Eigen::Map<const VectorX>(schur.data(), schur.size())};
}

bool same_bits(const std::vector<VectorX>& a, const std::vector<VectorX>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].size() != b[i].size() ||
        std::memcmp(a[i].data(), b[i].data(), sizeof(double) * static_cast<std::size_t>(a[i].size())) != 0)
      return false;
  return true;
}

}  // namespace

TEST_CASE("a factor has the same bits for any number of threads", "[linear][threads]") {
  const detail::CholeskyAnalysis analysis(large_case().lower, large_case().layout);
  REQUIRE(analysis.flops() > 7e8);  // enough work for seven threads
  const std::vector<VectorX> one = results_with(1);
  for (const int threads : {2, 3, 7})
    for (int repeat = 0; repeat < 3; ++repeat) CHECK(same_bits(one, results_with(threads)));
  OneByOne serial;
  CHECK(same_bits(one, results_with(serial)));
}

TEST_CASE("tasks of a factorisation cover all fronts once, children first", "[linear][threads]") {
  const detail::CholeskyAnalysis analysis(large_case().lower, large_case().layout);
  const detail::FrontTree& tree = analysis.tree();
  const detail::FrontTasks division = detail::divide_fronts(tree, tree.fronts.size());
  REQUIRE(division.tasks.size() > 20);
  std::vector<int> seen(static_cast<std::size_t>(tree.fronts.size()), 0);
  NodeId waiting = 0;
  for (Index t = 0; t < division.tasks.size(); ++t) {
    const detail::FrontTask& task = division.tasks[t];
    for (Index f = task.begin; f < task.end; ++f) {
      ++seen[static_cast<std::size_t>(f)];
      const NodeId parent = tree.fronts[f].parent;
      CHECK((f + 1 < task.end ? parent < task.end : parent < 0 || division.tasks[task.parent].begin == parent));
    }
    CHECK((task.parent < 0 || task.parent > t));
    waiting += task.children - (task.parent >= 0 ? 1 : 0);
  }
  CHECK(waiting == 0);
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

TEST_CASE("a factorisation by threads is refused and cancelled as by one", "[linear][threads]") {
  const SparseCase& c = large_case();
  const detail::CholeskyAnalysis analysis(c.lower, c.layout);
  SetupLimits limits;
  limits.threads = 3;
  SECTION("memory") {
    CHECK(analysis.peak_bytes(3) > analysis.peak_bytes(1));
    limits.memory = static_cast<std::size_t>(analysis.peak_bytes(3)) - 1;
    CHECK_REFUSED(SetupErrorKind::too_large, SparseCholesky(analysis, c.lower, limits));
  }
  SECTION("the same pivot") {
    SparseCase bad = c;
    bad.lower.valuePtr()[bad.lower.outerIndexPtr()[1000]] = -1.0;
    SetupProblem by_one, by_three;
    try {
      SparseCholesky(analysis, bad.lower, SetupLimits{});
    } catch (const SetupError& e) {
      by_one = e.problem();
    }
    try {
      SparseCholesky(analysis, bad.lower, limits);
    } catch (const SetupError& e) {
      by_three = e.problem();
    }
    CHECK(by_one.kind == SetupErrorKind::not_positive_definite);
    CHECK(by_one.kind == by_three.kind);
    CHECK(by_one.ids == by_three.ids);
    CHECK(by_one.what == by_three.what);
  }
  SECTION("cancelled, with progress in the calling thread only") {
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<bool> elsewhere{false};
    for (const int allowed : {1, 2}) {
      int calls = 0;
      limits.progress = [&](const Progress&) {
        if (std::this_thread::get_id() != caller) elsewhere = true;
        return ++calls <= allowed;
      };
      CHECK_REFUSED(SetupErrorKind::cancelled, SparseCholesky(analysis, c.lower, limits));
      CHECK(calls == allowed + 1);
    }
    CHECK_FALSE(elsewhere);
  }
}
