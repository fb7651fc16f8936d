// Latency of the tick and of its parts, with the rates of the machine for comparison. Every benchmark checks its
// result.
#include <benchmark/benchmark.h>

#include <Eigen/Core>

#include <string>

int main(int argc, char** argv) {
#if defined(__VERSION__)
  benchmark::AddCustomContext("compiler", __VERSION__);
#endif
#if !defined(NDEBUG)
  benchmark::AddCustomContext("assertions", "ON: times are not meaningful");
#endif
  benchmark::AddCustomContext("SIMD", Eigen::SimdInstructionSetsInUse());
  benchmark::AddCustomContext("vector register", std::to_string(EIGEN_MAX_STATIC_ALIGN_BYTES) + " bytes");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
