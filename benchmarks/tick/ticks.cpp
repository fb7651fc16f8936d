// Duration of a tick: in direct succession, after sleep with empty caches, and in a loop of 10 kHz.
#include "tick.hpp"

#include <palpate/haptic/haptic_loop.hpp>

#include <chrono>
#include <thread>

namespace tick {
namespace {

using palpate::platform::compute_ns;

std::string wrong_if(bool wrong) {
  return wrong ? "the pressed points are not on the sphere" : "";
}

/// Times of work() [s], each after writing 64 MB and sleeping for a millisecond; they include the cost of the clock.
template <class Work>
std::vector<double> cold_times(Work&& work) {
  std::vector<char> memory(std::size_t{64} << 20, 1);
  std::vector<double> times;
  for (int i = 0; i < 1000; ++i) {
    for (std::size_t k = 0; k < memory.size(); k += 64) ++memory[k];
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::int64_t start = compute_ns();
    work();
    times.push_back(1e-9 * static_cast<double>(compute_ns() - start));
  }
  return times;
}

/// The 99th percentile [s] of the wall times of arithmetic without memory accesses, whose median is about `median`:
/// shows whether interrupts affect that percentile.
double machine_p99(double median) {
  const auto work = [](int steps) {
    double x = 1.0;
    for (int i = 0; i < steps; ++i) x = 0.5 * x + 1.0;
    return x;
  };
  std::vector<double> times;
  volatile double sum = 0.0;
  const auto measure = [&](int steps, int repetitions) {
    times.clear();
    for (int i = 0; i < repetitions; ++i) {
      const std::int64_t start = palpate::platform::wall_ns();
      sum = sum + work(steps);
      times.push_back(1e-9 * static_cast<double>(palpate::platform::wall_ns() - start));
    }
    return bench::percentile(times, 0.5);
  };
  constexpr int steps = 2000;
  measure(static_cast<int>(steps * median / measure(steps, 1000)), 20000);
  return bench::percentile(times, 0.99);
}

}  // namespace

void measure_hot(bench::RowFile& rows, bench::Touching& body) {
  const bench::TickTimes hot = bench::hot_ticks(body);
  rows.add({.target = "i",
            .what = "hot tick, " + std::to_string(body.pressing()) + " contacts, p99",
            .figure = bench::microseconds(hot.p99) + " (p50 " + bench::microseconds(hot.p50) +
                      "; p99 of arithmetic of that length " + bench::microseconds(machine_p99(hot.p50)) + ")",
            .baseline = "5 us",
            .ratio = hot.p99 / 5e-6,
            .bound = bench::at_most(1.0),
            .error = wrong_if(!(body.gap_error() < 1e-5))});
}

void measure_cold(bench::RowFile& rows, bench::Touching& body) {
  const double empty = bench::percentile(cold_times([] {}), 0.5);
  const std::vector<double> times = cold_times([&] { body.tick(); });
  const double p50 = bench::percentile(times, 0.5) - empty, p99 = bench::percentile(times, 0.99) - empty;
  rows.add({.target = "i",
            .what = "tick after 1 ms of sleep, caches flushed, p99",
            .figure = bench::microseconds(p99) + " (p50 " + bench::microseconds(p50) +
                      ", less an empty one: " + bench::microseconds(empty) + ")",
            .baseline = "50 us",
            .ratio = p99 / 50e-6,
            .bound = bench::at_most(1.0),
            .error = wrong_if(!(body.gap_error() < 1e-5))});
}

/// The body as a device that requests ten thousand ticks per second.
struct At10Khz {
  bench::Touching& body;

  palpate::ToolState read() noexcept { return body.read(); }
  palpate::Status write(const palpate::GatedForce& force) noexcept { return body.write(force); }
  palpate::DeviceLimits limits() const noexcept { return {.rate = 1e4}; }
  void start() noexcept {}
  void stop() noexcept {}
};

void measure_10_khz(bench::RowFile& rows, bench::Touching& body) {
  palpate::LoopOptions options;
  options.duration = 5.0;
  options.cpu = 0;
  At10Khz fast{body};
  const palpate::LoopReport r = palpate::run_haptic_loop(fast, body.servo(), options);
  const auto at = [&](double p) { return std::max(0.0, r.compute.percentile(p) - r.clock_cost); };
  const double p50 = at(0.5);
  const auto add = [&](const char* what, double p, double allowed) {
    rows.add({.target = "l",
              .what = what,
              .figure = bench::microseconds(at(p)),
              .baseline = "p50 " + bench::microseconds(p50),
              .ratio = at(p) / p50,
              .bound = bench::at_most(allowed),
              .error = wrong_if(!(body.gap_error() < 1e-5))});
  };
  add("p99 / p50 of the tick's processor time at 10 kHz", 0.99, 4.0);
  add("p99.9 / p50 of the tick's processor time at 10 kHz", 0.999, 12.0);
  const double periods = r.rate * options.duration, missed = static_cast<double>(r.missed_deadlines);
  rows.add({.target = "l",
            .what = "share of 10 kHz periods without a tick: woken too late by the system",
            .figure = std::to_string(r.missed_deadlines) + " of 50000",
            .baseline = "lateness p50 " + bench::microseconds(r.lateness.percentile(0.5)) + ", p99 " +
                        bench::microseconds(r.lateness.percentile(0.99)),
            .ratio = missed / periods,
            .bound = {},
            .error = ""});
}

}  // namespace tick
