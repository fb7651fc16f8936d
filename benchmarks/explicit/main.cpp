// Explicit dynamics at large strain: force per element, steps in real time, drift over a million steps, and blocks
// with randomly displaced nodes: two hundred of each kind, ten thousand with --long.
//   bench_explicit [--build <name of the flags>] [--csv <file to add rows to>] [--long]
#include "explicit.hpp"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  for (const int n : {10, 16, 20}) explicit_path::measure_force(rows, n);
  explicit_path::measure_real_time(rows, 20);
  explicit_path::measure_drift(rows);
  explicit_path::measure_scrambles(rows, bench::has_option(argc, argv, "--long") ? 10000 : 200);
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_explicit: %s\n", e.what());
  return 1;
}
