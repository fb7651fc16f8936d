// Threads of a set-up.
#include "catch.hpp"

#include <palpate/core/executor.hpp>
#include <palpate/testing/executor_laws.hpp>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace palpate;

namespace {

/// A pool that promises four threads and has only the calling one.
struct BusyPool {
  int threads() const noexcept { return 4; }
  void run(int count, const ExecutorTask& task) const {
    for (int i = count - 1; i >= 0; --i) task(i);
  }
};

struct LosesTasks : BusyPool {
  void run(int count, const ExecutorTask& task) const {
    for (int i = 0; i + 1 < count; ++i) task(i);
  }
};
struct Elsewhere : BusyPool {
  void run(int count, const ExecutorTask& task) const {
    std::thread([&] {
      for (int i = 0; i < count; ++i) task(i);
    }).join();
  }
};
struct ReturnsNothing {
  int threads() const noexcept { return 1; }
};

}  // namespace

static_assert(Executor<BusyPool>);
static_assert(!Executor<ReturnsNothing>);

TEST_CASE("laws of executors", "[core][executor]") {
  for (const int threads : {1, 2, 3, 7}) {
    detail::StartedThreads started(threads);
    CHECK(started.threads() == threads);
    CHECK(testing::describe(testing::executor_laws(started)) == "");
    SetupThreads any(threads);
    CHECK(testing::describe(testing::executor_laws(any)) == "");
  }
  BusyPool busy;
  CHECK(testing::describe(testing::executor_laws(busy)) == "");
  SetupThreads of_busy(busy);
  CHECK(of_busy.threads() == 4);
  CHECK(testing::describe(testing::executor_laws(of_busy)) == "");
  CHECK(detail::StartedThreads().threads() >= 1);
}

TEST_CASE("laws of executors can fail", "[core][executor]") {
  LosesTasks loses;
  CHECK(testing::violates(testing::executor_laws(loses), "every task exactly once"));
  Elsewhere elsewhere;
  CHECK(testing::violates(testing::executor_laws(elsewhere), "the calling thread takes part"));
}
