// Timing of a tick: processor time of the thread, in batches, because reading that clock costs as much as a tick.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <palpate/core/platform.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <vector>

namespace latency {

/// Processor time of this thread [s].
inline double thread_seconds() noexcept {
  return 1e-9 * static_cast<double>(palpate::platform::compute_ns());
}

/// Durations and their percentiles. Memory is reserved in advance: recording does not allocate.
class Samples {
 public:
  explicit Samples(std::size_t most) { seconds_.reserve(most); }
  void record(double seconds) {
    if (seconds_.size() < seconds_.capacity()) seconds_.push_back(std::max(0.0, seconds));
  }
  double percentile(double fraction) {
    if (seconds_.empty()) return 0.0;
    const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(seconds_.size() - 1));
    std::nth_element(seconds_.begin(), seconds_.begin() + at, seconds_.end());
    return seconds_[static_cast<std::size_t>(at)];
  }

 private:
  std::vector<double> seconds_;
};

constexpr int batches = 2500;       ///< per benchmark
constexpr int ticks_per_batch = 8;  ///< between two readings of the clock
constexpr int single_ticks = 4000;  ///< timed one by one

/// Times tick(): p50 and p99 over batches (each the mean of its ticks), and the percentiles of single ticks minus
/// the median cost of the clock. For benchmarks registered with ->UseManualTime()->Iterations(batches).
template <class Tick>
void sample_ticks(benchmark::State& state, Tick&& tick) {
  for (int i = 0; i < 200; ++i) tick();
  Samples batch(batches), single(single_ticks);
  for (auto _ : state) {
    const double start = thread_seconds();
    for (int i = 0; i < ticks_per_batch; ++i) tick();
    const double each = (thread_seconds() - start) / ticks_per_batch;
    batch.record(each);
    state.SetIterationTime(each);
  }
  const double clock = palpate::detail::measured_clock_cost();
  for (int i = 0; i < single_ticks; ++i) {
    const double start = thread_seconds();
    tick();
    single.record(thread_seconds() - start - clock);
  }
  state.counters["p50_us"] = 1e6 * batch.percentile(0.5);
  state.counters["p99_us"] = 1e6 * batch.percentile(0.99);
  state.counters["single_p50"] = 1e6 * single.percentile(0.5);
  state.counters["single_p99"] = 1e6 * single.percentile(0.99);
  state.counters["single_p999"] = 1e6 * single.percentile(0.999);
}

/// Options of every benchmark that calls sample_ticks.
inline void as_ticks(benchmark::internal::Benchmark* b) {
  b->UseManualTime()->Iterations(batches)->Unit(benchmark::kMicrosecond);
}

}  // namespace latency
