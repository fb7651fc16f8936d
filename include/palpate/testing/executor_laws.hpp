// The laws of core/executor.hpp.
#pragma once

#include <palpate/core/executor.hpp>
#include <palpate/testing/violation.hpp>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// "at least one thread", "every task exactly once", "the calling thread takes part" and "returns when all are done".
template <Executor E>
Violations executor_laws(E& executor) {
  Violations v;
  const int threads = executor.threads();
  expect_at_least(v, "at least one thread", threads, 1.0);
  const std::thread::id caller = std::this_thread::get_id();
  for (int count = 0; count <= threads; ++count) {
    std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
    std::atomic<int> by_caller{0}, started{0}, done{0};
    executor.run(count, [&](int task) {
      ++started;
      if (task < 0 || task >= count) return;
      ++calls[static_cast<std::size_t>(task)];
      by_caller += std::this_thread::get_id() == caller;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ++done;
    });
    const std::string of = std::to_string(count) + " tasks";
    bool once = started == count;
    for (const std::atomic<int>& n : calls) once = once && n == 1;
    expect_true(v, "every task exactly once", once, of);
    expect_true(v, "the calling thread takes part", count == 0 || by_caller > 0, of);
    expect_true(v, "returns when all are done", done == count, of);
  }
  return v;
}

}}}  // namespace palpate::testing
