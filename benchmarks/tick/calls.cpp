// Heap calls and mutex locks of a tick. malloc and pthread_mutex_lock of this program are replaced by counting
// versions.
#define PALPATE_COUNT_ALLOCATIONS
#include <palpate/testing/allocation_counter.hpp>

#include "tick.hpp"

#include <mutex>

#if defined(__GLIBC__)
#include <dlfcn.h>
#include <pthread.h>

namespace {
constinit thread_local volatile std::uint64_t locks = 0;
}
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) {
  using Lock = int (*)(pthread_mutex_t*);
  static const Lock real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  locks = locks + 1;
  return real(mutex);
}
#else
namespace {
thread_local volatile std::uint64_t locks = 0;
}
#endif

namespace tick {

void measure_calls(bench::RowFile& rows, bench::Touching& body) {
  constexpr int ticks = 10000;
  std::mutex mutex;
  const std::uint64_t untouched = locks;
  { const std::lock_guard control(mutex); }
  const bool counts_locks = locks == untouched + 1;
  const palpate::testing::AllocationScope scope;
  const std::uint64_t before = locks;
  for (int i = 0; i < ticks; ++i) body.tick();
  const std::uint64_t heap = scope.allocations() + scope.frees(), locked = locks - before;
  const auto add = [&](const char* what, bool counted, std::uint64_t calls) {
    if (!counted) return rows.skip("k", what, "such calls cannot be counted here");
    rows.add({.target = "k",
              .what = what,
              .figure = std::to_string(calls) + " in 10,000 ticks",
              .baseline = "0",
              .ratio = static_cast<double>(calls),
              .bound = bench::at_most(0.0),
              .error = ""});
  };
  add("heap calls of a tick", palpate::testing::allocations_are_counted(), heap);
  add("mutexes locked in a tick", counts_locks, locked);
}

}  // namespace tick
