// Implicit steps: time of co-rotated steps compared with plain Eigen and Bullet, the error of every short cut, the
// largest block at 1 kHz, and the drift of long motions; with --long over a million steps, and ten thousand blocks with
// randomly displaced nodes.
//   bench_implicit [--build <name of the flags>] [--csv <file to add rows to>] [--quick] [--long] [--energy STEPS]
//                  [--scrambles RUNS]
#include "drift.hpp"
#include "implicit.hpp"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  if (const int steps = std::stoi(bench::option(argc, argv, "--energy", "0")); steps > 0) {
    measure_energy_in_contact(rows, steps);
    return rows.failed() ? 1 : 0;
  }
  if (const int runs = std::stoi(bench::option(argc, argv, "--scrambles", "0")); runs > 0) {
    measure_implicit_scrambles(rows, runs);
    return rows.failed() ? 1 : 0;
  }
  implicit_path::measure_steps(rows, 10, 1e-3);
  implicit_path::measure_steps(rows, 16, 5e-3);
  if (bench::has_option(argc, argv, "--quick")) return rows.failed() ? 1 : 0;
  for (const int n : {6, 10, 16}) implicit_path::measure_bullet(rows, n);
  implicit_path::measure_preconditioners(rows, 10);
  implicit_path::measure_largest(rows);
  const bool all = bench::has_option(argc, argv, "--long");
  measure_implicit_drift(rows, all ? 1000000 : 20000);
  measure_implicit_scrambles(rows, all ? 10000 : 50);
  measure_energy_in_contact(rows, all ? 1000000 : 2000);
  measure_static_hold(rows, all ? 1000000 : 10000);
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_implicit: %s\n", e.what());
  return 1;
}
