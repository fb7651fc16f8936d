// Bandwidth and arithmetic rate of this machine, measured in the same run as everything else.
#include <Eigen/Core>
#include <cstring>
#include <memory>
#include <palpate/concepts/haptic_device.hpp>

#include "sampling.hpp"

namespace {

using Index = Eigen::Index;

void memcpy_bandwidth(benchmark::State& state) {
  const std::vector<char> from(std::size_t{64} << 20, 1);
  std::vector<char> to(from.size());
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::ClobberMemory();
  }
  if (to != from) state.SkipWithError("memcpy did not copy");
  state.counters["GB/s"] =
      benchmark::Counter(2e-9 * static_cast<double>(from.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(memcpy_bandwidth)->Name("machine/memcpy_64MB")->Unit(benchmark::kMillisecond);

/// Eight independent partial sums: with fewer, the latency of the adder limits the rate, not memory.
double sum_of(const double* p, Index count) {
  using Lane = Eigen::Array<double, 8, 1>;
  using Map = Eigen::Map<const Lane>;
  Lane a = Lane::Zero(), b = a, c = a, d = a, e = a, f = a, g = a, h = a;
  for (Index i = 0; i < count; i += 64) {
    a += Map(p + i);
    b += Map(p + i + 8);
    c += Map(p + i + 16);
    d += Map(p + i + 24);
    e += Map(p + i + 32);
    f += Map(p + i + 40);
    g += Map(p + i + 48);
    h += Map(p + i + 56);
  }
  return (a + b + c + d + e + f + g + h).sum();
}

void read_bandwidth(benchmark::State& state) {
  const Index count = state.range(0) * 1024 / 8;
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(count);
  double sum = 0.0;
  for (auto _ : state) benchmark::DoNotOptimize(sum = sum_of(data.data(), count));
  if (sum != static_cast<double>(count)) state.SkipWithError("the sum is wrong");
  state.counters["GB/s"] =
      benchmark::Counter(8e-9 * static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(read_bandwidth)
    ->Name("machine/read_KB")
    ->Arg(16)
    ->Arg(1024)
    ->Arg(16 << 10)
    ->Arg(512 << 10)
    ->Unit(benchmark::kMicrosecond);

template <class Scalar>
void gemm(benchmark::State& state) {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  constexpr Index n = 512;
  const Matrix a = Matrix::Constant(n, n, Scalar(0.5)), b = Matrix::Constant(n, n, Scalar(2));
  Matrix c(n, n);
  for (auto _ : state) {
    c.noalias() = a * b;
    benchmark::DoNotOptimize(c.data());
  }
  if (!(c.array() == Scalar(n)).all()) state.SkipWithError("the product is wrong");
  state.counters["GFLOP/s"] = benchmark::Counter(2e-9 * n * n * n, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_TEMPLATE(gemm, double)->Name("machine/gemm_512_double")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(gemm, float)->Name("machine/gemm_512_float")->Unit(benchmark::kMillisecond);

/// Control: an empty call, timed like a tick. Its time is the cost of the clock.
void empty_tick(benchmark::State& state) {
  palpate::ToolState tool;
  latency::sample_ticks(state, [&] { benchmark::DoNotOptimize(tool); });
}
BENCHMARK(empty_tick)->Name("machine/empty_tick")->Apply(latency::as_ticks);

}  // namespace
