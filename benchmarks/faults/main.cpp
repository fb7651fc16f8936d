// Effect of stalls and bad input on the rendered force in a session with moving tissue: a table whose rows are checked.
//   bench_faults
#include "faults.hpp"

#include <cstdio>

int main() {
  using namespace faults;
  struct Case {
    const char* name;
    Fault fault;
  };
  const Case cases[] = {{"none", {}},
                        {"tissue 2 ms", {.tissue_stall = 0.002}},
                        {"tissue 20 ms", {.tissue_stall = 0.02}},
                        {"tissue 50 ms", {.tissue_stall = 0.05}},
                        {"tissue 100 ms", {.tissue_stall = 0.1}},
                        {"tissue 200 ms", {.tissue_stall = 0.2}},
                        {"tissue 700 ms", {.tissue_stall = 0.7}},
                        {"device 1 ms", {.device_stall = 0.001}},
                        {"device 10 ms", {.device_stall = 0.01}},
                        {"device 50 ms", {.device_stall = 0.05}},
                        {"both 100, 10 ms", {.tissue_stall = 0.1, .device_stall = 0.01}},
                        {"bad input", {.bad_input = true}}};
  std::printf("%-16s | %8s %8s %8s | %9s %9s %9s | %11s %11s %9s %9s\n", "fault, each s", "peak N", "step N", "raw N",
              "given mJ", "taken mJ", "tank mJ", "stale", "missed", "lost", "bad");
  int wrong = 0;
  const auto limits = palpate::ForceLimits::from(device);
  const auto energy = palpate::EnergyLimits::from(device);
  double steady = 0.0;
  for (const Case& c : cases) {
    const Outcome o = run(c.fault, 0.01);
    std::printf("%-16s | %8.3f %8.4f %8.4f | %9.4f %9.3f %9.3f | %5d/%-5d %5d/%-5d %4d/%-4d %4d/%-4d\n", c.name, o.peak,
                o.step, o.raw_step, 1e3 * o.given, 1e3 * o.taken, 1e3 * o.tank, o.stale, o.stale_due, o.missed,
                o.missed_due, o.disconnected, o.disconnected_due, o.bad, o.bad_due);
    if (c.name == cases[0].name) steady = o.last_force;
    const bool counted = o.stale == o.stale_due && o.missed == o.missed_due && o.disconnected == o.disconnected_due &&
                         o.bad == o.bad_due;
    const bool within_limits =
        o.not_finite == 0 && o.peak <= limits.peak_force && o.step <= limits.slew_rate * tick * (1.0 + 1e-9);
    const bool bounded = o.given <= energy.allowance + energy.refill * duration && (c.fault.fades() || o.taken >= 0.0);
    if (!counted || !within_limits || !bounded || std::abs(o.last_force - steady) > 0.05 * steady) {
      ++wrong;
      std::printf(
          "WRONG: flags %d, force limits %d, energy %d (1: as required), force one second later %g instead of %g N\n",
          counted, within_limits, bounded, o.last_force, steady);
    }
  }
  return wrong == 0 ? 0 : 1;
}
