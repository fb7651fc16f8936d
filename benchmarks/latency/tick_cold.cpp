// The tick under the conditions of a device: after sleep, with caches emptied by other processes.
#include <chrono>
#include <thread>

#include "palpation.hpp"

namespace {

using namespace latency;

constexpr int ticks = 1000;

/// Writes 64 MB, one entry per cache line.
void flush_caches() {
  static std::vector<char> memory(std::size_t{64} << 20, 1);
  for (std::size_t i = 0; i < memory.size(); i += 64) ++memory[i];
  benchmark::DoNotOptimize(memory.data());
}

/// Sleeps a millisecond before every tick, and empties the caches before that if `flush`. The empty row shows the cost
/// of reading the clock under the same conditions.
template <class Tick>
void run(benchmark::State& state, bool flush, Tick tick) {
  const double clock = palpate::detail::measured_clock_cost();
  Samples single(ticks);
  for (auto _ : state) {
    if (flush) flush_caches();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const double start = thread_seconds();
    tick();
    const double seconds = std::max(1e-9, thread_seconds() - start - clock);
    single.record(seconds);
    state.SetIterationTime(seconds);
  }
  state.counters["p50_us"] = 1e6 * single.percentile(0.5);
  state.counters["p99_us"] = 1e6 * single.percentile(0.99);
}

void empty(benchmark::State& state, bool flush) {
  int nothing = 0;
  run(state, flush, [&] { benchmark::DoNotOptimize(nothing); });
}

void tick(benchmark::State& state, bool flush) {
  static Palpation<palpate::Condensed<palpate::SelectiveInverse>> s(blocks[1]);
  s.press_until(10);
  run(state, flush, [&] { benchmark::DoNotOptimize(s.tick()); });
  s.describe(state);
  if (!(s.gap_error() < 1e-5)) state.SkipWithError("the pressed points are not on the sphere");
}

void as_single(benchmark::internal::Benchmark* b) {
  b->UseManualTime()->Iterations(ticks)->Unit(benchmark::kMicrosecond);
}
BENCHMARK_CAPTURE(empty, paced, false)->Name("paced/empty")->Apply(as_single);
BENCHMARK_CAPTURE(tick, paced, false)->Name("paced/tick")->Apply(as_single);
BENCHMARK_CAPTURE(empty, cold, true)->Name("paced/empty_cold")->Apply(as_single);
BENCHMARK_CAPTURE(tick, cold, true)->Name("paced/tick_cold")->Apply(as_single);

}  // namespace
