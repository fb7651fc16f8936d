// Solves with a factor by several threads.
#include "catch.hpp"

#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/parallel_sweeps.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "linear/large_case.hpp"

using namespace palpate;
using namespace test;

namespace {

/// Runs some tasks, or none, and throws.
struct Throwing {
  int run_before = 0;
  int threads() const noexcept { return 3; }
  void run(int, const ExecutorTask& task) const {
    for (int i = 0; i < run_before; ++i) task(i);
    throw std::runtime_error("no thread");
  }
};

/// Two bodies without a connection: the tree has two roots. Nothing is known about the dofs.
SparseCase two_bodies() {
  const SparseMatrix& one = large_case().lower;
  const Index n = one.rows();
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index j = 0; j < n; ++j)
    for (SparseMatrix::InnerIterator it(one, j); it; ++it)
      for (const Index at : {Index{0}, n}) entries.emplace_back(at + it.row(), at + j, it.value());
  SparseCase c{"two bodies", SparseMatrix(2 * n, 2 * n), {}};
  c.lower.setFromTriplets(entries.begin(), entries.end());
  return c;
}

/// Kept dofs at different depths of the tree.
std::vector<Index> every(Index step, Index size) {
  std::vector<Index> kept;
  for (Index i = step / 2; i < size; i += step) kept.push_back(i);
  return kept;
}

VectorX wave(Index size) {
  VectorX b(size);
  for (Index i = 0; i < size; ++i) b[i] = std::sin(static_cast<double>(i));
  return b;
}

bool same_bits(const VectorX& a, const VectorX& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

struct Solutions {
  VectorX whole, condensed, recovered;
  bool operator==(const Solutions& o) const {
    return same_bits(whole, o.whole) && same_bits(condensed, o.condensed) && same_bits(recovered, o.recovered);
  }
};

Solutions solve_on(const SetupThreads& threads, SparseCholesky whole, SparseCholesky interior) {
  const VectorX b = wave(whole.size());
  Solutions s{VectorX(b.size()), VectorX(interior.kept()), VectorX(b.size())};
  whole.solve_into(b, s.whole, threads);
  interior.eliminate_into(b, s.condensed, threads);
  interior.recover_into(wave(interior.kept()), s.recovered, threads);
  return s;
}

}  // namespace

TEST_CASE("a solve has the same bits for any number of threads", "[linear][threads]") {
  std::vector<SparseCase> cases{large_case(), two_bodies()};
  for (SparseCase& c : cases) {
    INFO(c.name);
    const SparseCholesky whole(detail::CholeskyAnalysis(c.lower, c.layout), c.lower, {});
    REQUIRE(detail::ParallelSweeps::are_worthwhile(whole.analysis().tree(), 2));
    c.layout.kept = every(97, c.lower.rows());
    MatrixX schur;
    const SparseCholesky interior =
        SparseCholesky::interior(detail::CholeskyAnalysis(c.lower, c.layout), c.lower, schur, {});
    const Solutions one = solve_on(1, whole, interior);
    for (const int threads : {2, 3, 7})
      for (int repeat = 0; repeat < 3; ++repeat) CHECK(solve_on(threads, whole, interior) == one);
    OneByOne serial;
    CHECK(solve_on(serial, whole, interior) == one);
    for (const int run_before : {0, 1}) {
      Throwing refuses{run_before};
      CHECK(solve_on(refuses, whole, interior) == one);
    }
    const VectorX b = wave(whole.size());
    const VectorX residual = c.lower.selfadjointView<Eigen::Lower>() * one.whole - b;
    CHECK(residual.norm() <= 1e-11 * b.norm());
  }
}
