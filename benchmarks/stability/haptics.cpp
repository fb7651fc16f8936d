// Z-width: the largest wall stiffness without sustained oscillation, for simulated devices, grips, rates and delays.
// Every figure that has a formula is checked against it.
#include <palpate/core/setup_error.hpp>
#include "stability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace stability {
namespace {

int failures = 0;
void expect(bool holds, const Cell& c, const char* what, double got, double wanted) {
  if (holds) return;
  ++failures;
  std::printf("WRONG %s, %s, %g Hz, %d ticks: %s is %.5g, not %.5g\n", c.device->name, c.hand->name, c.rate, c.delay,
              what, got, wanted);
}

void measure(Cell& c) {
  c.exact = limit_by_eigenvalues(c.options(), c.delay);
  c.linear = largest_linear(c, c.exact);
  expect(std::abs(c.linear - c.exact) <= 0.01 * c.exact, c, "limit of the linear loop", c.linear, c.exact);
  const double b = c.device->options.damping, period = 1.0 / c.rate;
  if (c.hand->hand.mass <= 0.0 && b * period / c.device->options.mass < 0.02) {
    const double formula = testing::stiffness_limit(b, period, c.delay * period);
    expect(std::abs(c.linear - formula) <= 0.02 * formula, c, "limit without a hand", c.linear, formula);
  }
  c.stable = largest_stable(c, false);
  c.late = largest_stable(c, true);
  c.power = motor_power(c, 4.0 * c.stable, false);
  c.power_tank = motor_power(c, 4.0 * c.stable, true);
  // Below 20 N/m a force of 1 N presses the tool beyond the extent of the wall.
  if (c.exact > 20.0) expect(c.stable >= 0.9 * c.linear, c, "limit with friction", c.stable, c.linear);
}

std::vector<Cell> measure_all() {
  std::vector<Cell> cells;
  for (const NamedDevice& device : devices()) {
    const SimulatedOptions& o = device.options;
    std::printf("\n%s: mass %.3g kg, damping %.3g N s/m, friction %.3g N, encoder %.3g um, rated %.4g N/m at 1 kHz\n",
                device.name, o.mass, o.damping, o.friction, 1e6 * o.encoder_step, o.limits.stiffness);
    std::printf("passive up to 2b/T = %.4g N/m at 1 kHz and 2f/step = %.4g N/m\n", 2e3 * o.damping,
                2.0 * o.friction / o.encoder_step);
    std::printf("%-8s %6s %6s | %9s %9s | %9s %9s | motors at 4x stable, and with tank [mW]\n", "hand", "rate", "delay",
                "linear", "exact", "stable", "late");
    for (const NamedHand& hand : hands())
      for (double rate : rates)
        for (int delay : delays) {
          Cell c{.device = &device, .hand = &hand, .rate = rate, .delay = delay};
          measure(c);
          std::printf("%-8s %6.0f %6d | %9.4g %9.4g | %9.3g %9.3g | %9.3g %9.3g\n", hand.name, rate, delay, c.linear,
                      c.exact, c.stable, c.late, 1e3 * c.power, 1e3 * c.power_tank);
          std::fflush(stdout);
          cells.push_back(c);
        }
  }
  return cells;
}

/// At the rated stiffness of the device, the energy tank must not reduce forces at 1 kHz, for every hand.
void check_rated() {
  for (const NamedDevice& device : devices())
    for (const NamedHand& hand : hands()) {
      Cell c{.device = &device, .hand = &hand, .rate = 1000.0, .delay = 0};
      SimulatedOptions o = c.options();
      SimulatedDevice handle(o);
      handle.start();
      const double rated = o.limits.stiffness;
      testing::Tanked<testing::VirtualWall> wall{.source = {.stiffness = rated},
                                                 .tank = EnergyTank(EnergyLimits::from(o.limits))};
      double least = infinity;
      for (int i = 0; i < 20000; ++i) {  // pressed with a force that varies from 0 to 2 N
        handle.push(Vector3(0.0, 0.0, -1.0 + std::cos(6e-3 * i)));
        testing::tick(handle, wall);
        least = std::min(least, wall.tank.gain());
      }
      expect(least >= 1.0, c, "least gain of the tank at the rated stiffness", least, 1.0);
    }
}

void measure_tissues() {
  SimulatedOptions o = SimulatedOptions::stylus();
  const double limit = testing::stiffness_limit(o.damping, 1.0 / o.rate, 0.0);
  std::printf(
      "\nblock of 9 216 Tet4 under a sphere of 4 mm, 0.1 N, stylus without hand, friction and encoder steps:\n");
  Cell c{.device = devices().data(), .hand = hands().data(), .rate = o.rate, .delay = 0};
  for (double e : {30e3, 100e3, 300e3, 1e6}) {
    const TissueRow row = measure_tissue(e, o);
    std::printf(
        "E %6.0f kPa: tissue alone %7.4g N/m; largest stable coupling %9.4g N/m, rendered %7.4g N/m "
        "(limit of a wall %.4g)\n",
        1e-3 * e, row.soft, row.coupling, row.rendered, limit);
    if (row.soft < 0.9 * limit)  // soft enough for any coupling
      expect(row.rendered >= 0.99 * row.soft, c, "rendered stiffness of a soft tissue", row.rendered, row.soft);
    else
      expect(std::abs(row.rendered - limit) <= 0.1 * limit, c, "rendered stiffness at the limit", row.rendered, limit);
  }
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}
void summarise(const std::vector<Cell>& cells) {
  std::vector<double> bare, tanked, late;
  for (const Cell& c : cells)
    if (c.rate > 999.0) {
      bare.push_back(1e3 * c.power);
      tanked.push_back(1e3 * c.power_tank);
      late.push_back(c.late / c.stable);
    }
  std::printf(
      "\nmedians at 1 kHz: motors at 4x the stable stiffness %.3g mW, with a tank %.3g mW; late reads reduce it to "
      "%.2f\n",
      median(bare), median(tanked), median(late));
}

void write_csv(const std::vector<Cell>& cells, const std::string& path) {
  std::ofstream out(path);
  out << "device,hand,rate_hz,delay_ticks,linear,exact,energy_bounded,late,motors_4x_w,motors_4x_tank_w\n";
  for (const Cell& c : cells)
    out << c.device->name << ',' << c.hand->name << ',' << c.rate << ',' << c.delay << ',' << c.linear << ',' << c.exact
        << ',' << c.stable << ',' << c.late << ',' << c.power << ',' << c.power_tank << '\n';
}

/// A panel per device and grip: stiffness that is passive, that is stable without being passive, and that oscillates.
std::vector<maps::Grid> grids_of(const std::vector<Cell>& cells) {
  std::vector<maps::Grid> grids;
  std::vector<std::string> rows;
  std::vector<double> stiffness;
  for (int halves = 2; halves <= 12; ++halves) {
    stiffness.push_back(std::pow(10.0, 0.5 * halves));
    rows.push_back(maps::power_of_ten(halves));
  }
  const std::size_t columns = rates.size() * delays.size();
  for (std::size_t first = 0; first < cells.size(); first += columns) {
    maps::Grid grid{.title = std::string(cells[first].device->name) + ", " + cells[first].hand->name,
                    .columns = {},
                    .rows = rows,
                    .squares = {}};
    std::vector<double> passive;
    for (std::size_t c = 0; c < columns; ++c) {
      const Cell& cell = cells[first + c];
      const double limit =
          testing::stiffness_limit(cell.device->options.damping, 1.0 / cell.rate, cell.delay / cell.rate);
      passive.push_back(limit);
      grid.columns.push_back(std::to_string(static_cast<int>(cell.rate)) + " Hz +" + std::to_string(cell.delay));
      grid.line.push_back({static_cast<double>(c), 2.0 * std::log10(limit) - 2.0});
    }
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        const Cell& cell = cells[first + c];
        const bool is_stable = stiffness[r] <= cell.stable;
        const char* const what = stiffness[r] <= passive[c] && is_stable ? "passive"
                                 : is_stable                             ? "stable"
                                                                         : "oscillates";
        grid.squares.push_back({is_stable ? maps::Verdict::ok : maps::Verdict::flagged,
                                stiffness[r] <= passive[c] && is_stable ? 1
                                : is_stable                             ? 4
                                                                        : 6,
                                grid.title + ", " + grid.columns[c] + ", " + rows[r] + " N/m: " + what});
      }
    grids.push_back(std::move(grid));
  }
  return grids;
}

}  // namespace

int measure_haptics(const std::string& folder, std::vector<maps::Grid>& grids) {
  const auto cells = measure_all();
  write_csv(cells, folder + "/stability.csv");
  write_map(cells, folder + "/stability.svg");
  summarise(cells);
  check_rated();
  measure_tissues();
  grids = grids_of(cells);
  std::printf("\n%d figures differ from their formula; written: %s/stability.svg, stability.csv\n", failures,
              folder.c_str());
  return failures;
}

}  // namespace stability
