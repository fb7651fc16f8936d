// Implicit steps of co-rotated tetrahedra: time against plain Eigen and Bullet, and the error of every short cut.
//   bench_implicit [--build <name of the flags>] [--csv <file to add rows to>] [--quick]
#include "implicit.hpp"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  implicit_path::measure_steps(rows, 10, 1e-3);
  implicit_path::measure_steps(rows, 16, 5e-3);
  if (bench::has_option(argc, argv, "--quick")) return rows.failed() ? 1 : 0;
  for (const int n : {6, 10, 16}) implicit_path::measure_bullet(rows, n);
  implicit_path::measure_preconditioners(rows, 10);
  implicit_path::measure_largest(rows);
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_implicit: %s\n", e.what());
  return 1;
}
