// The haptic tick of ten contacts on a patch of 289 nodes: with warm and cold caches, at 10 kHz, its heap calls and
// locks, and the selective product, its main part.
//   bench_tick [--build <name of the flags>] [--csv <file to add rows to>]
#include "tick.hpp"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) try {
  bench::RowFile rows(bench::option(argc, argv, "--csv", ""), bench::option(argc, argv, "--build", "this"));
  bench::Touching body(bench::touch_block(16, 16));
  body.press_until(10);
  tick::measure_hot(rows, body);
  tick::measure_cold(rows, body);
  tick::measure_products(rows);
  tick::measure_calls(rows, body);
  tick::measure_10_khz(rows, body);
  return rows.failed() ? 1 : 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "bench_tick: %s\n", e.what());
  return 1;
}
