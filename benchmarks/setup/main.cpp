// Set-up, stage by stage, on the standard block and on irregular bodies, compared with other implementations.
//   bench_setup [--build <name of the flags>] [--csv <file to add rows to>] [--organ <organ.msh>] [--long]
//               [--threads | --iterative: only these rows]
#include "cholmod.hpp"
#include "setup.hpp"

#include <Eigen/Core>

#include <cstdio>
#include <exception>

namespace setup {

void measure_machine(Session& session) {
  const auto inform = [&](const char* what, const std::string& figure) {
    session.rows.add({.target = "machine", .what = what, .figure = figure, .baseline = "", .bound = {}, .error = ""});
  };
#if defined(__VERSION__)
  inform("compiler", __VERSION__);
#endif
#if !defined(NDEBUG)
  inform("assertions", "ON: times are not meaningful");
#endif
  inform("SIMD", std::string(Eigen::SimdInstructionSetsInUse()) + ", " +
                     std::to_string(8 * EIGEN_MAX_STATIC_ALIGN_BYTES) + " bit");
  inform("CHOLMOD", bench::Cholmod::available() ? bench::Cholmod::blas() : "not installed (libsuitesparse-dev)");
  inform("Eigen gemm 512, double", bench::gigaflops(bench::gemm_rate()));
  inform("Eigen gemm 512, float", bench::gigaflops(bench::gemm_rate<float>()));
  inform("memcpy 64 MB, read + write", bench::gigabytes_per_second(bench::memcpy_bandwidth()));
  for (const auto& [name, bytes] :
       {std::pair{"read 16 KB", 16e3}, {"read 1 MB", 1e6}, {"read 16 MB", 16e6}, {"read 512 MB", 512e6}})
    inform(name, bench::gigabytes_per_second(bench::read_bandwidth(bytes)));
}

}  // namespace setup

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  const std::string organ = bench::option(argc, argv, "--organ", PALPATE_BENCH_DATA "/organ.msh");
  setup::Session session{rows, bench::has_option(argc, argv, "--long")};
  if (bench::has_option(argc, argv, "--threads")) {
    setup::measure_threads(session);
    return rows.failed() ? 1 : 0;
  }
  if (bench::has_option(argc, argv, "--iterative")) {
    setup::measure_iterative(session);
    return rows.failed() ? 1 : 0;
  }
  setup::measure_machine(session);
  setup::measure_memory(session);  // first: blocks that other work leaves in the heap would count
  setup::measure_assembly(session);
  setup::measure_factorisation(session);
  setup::measure_irregular(session, organ.c_str());
  setup::measure_solves(session);
  setup::measure_condensation(session);
  setup::measure_iterative(session);
  setup::measure_models(session, organ.c_str());
  setup::measure_threads(session);
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_setup: %s\n", e.what());
  return 1;
}
