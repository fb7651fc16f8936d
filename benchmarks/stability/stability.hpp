// The largest stiffness that a simulated device renders without oscillation: parameters that are varied, and its
// search.
#pragma once

#include <palpate/haptic/energy_tank.hpp>
#include <palpate/testing/stability.hpp>

#include "grid.hpp"

#include <array>
#include <string>
#include <vector>

namespace stability {

using namespace palpate;

struct NamedDevice {
  const char* name;
  SimulatedOptions options;
};
inline const std::array<NamedDevice, 4>& devices() {
  static const std::array<NamedDevice, 4> all{{{"stylus", SimulatedOptions::stylus()},
                                               {"precise stylus", SimulatedOptions::precise_stylus()},
                                               {"game controller", SimulatedOptions::game_controller()},
                                               {"parallel arm", SimulatedOptions::parallel_arm()}}};
  return all;
}
struct NamedHand {
  const char* name;
  SimulatedHand hand;
};
inline constexpr int hand_count = 3;
inline const std::array<NamedHand, hand_count>& hands() {
  static const std::array<NamedHand, hand_count> all{
      {{"no hand", SimulatedHand::none()}, {"light", SimulatedHand::light()}, {"firm", SimulatedHand::firm()}}};
  return all;
}
inline constexpr std::array<double, 4> rates{1000.0, 500.0, 300.0, 60.0};
inline constexpr std::array<int, 3> delays{0, 1, 2};  ///< ticks
inline constexpr double highest = 1e6;                ///< [N/m] upper end of the search

/// One cell of the map.
struct Cell {
  const NamedDevice* device;
  const NamedHand* hand;
  double rate;
  int delay;
  double linear = 0.0;      ///< [N/m] largest stable stiffness without friction and encoder steps
  double exact = 0.0;       ///< the same from the eigenvalues of the sampled loop
  double stable = 0.0;      ///< [N/m] largest stable stiffness with both, and with the peak force
  double late = 0.0;        ///< [N/m] the same with jitter and stalls
  double power = 0.0;       ///< [W] of the motors at four times `stable`
  double power_tank = 0.0;  ///< the same with an energy tank

  SimulatedOptions options() const {
    SimulatedOptions o = device->options;
    o.hand = hand->hand;
    o.rate = rate;
    o.delay = delay / rate;
    return o;
  }
};

/// Motion of a handle pushed into a wall with 1 N, after the initial transient.
struct InWall {
  double travel = 0.0;  ///< [m] in the last half second
  double power = 0.0;   ///< [W] of the motors, in the last half second
};
/// `late`: every read is up to half a period late, and every 0.31 s one is five periods late.
template <class MakeServo>
InWall in_wall(const Cell& cell, MakeServo make_servo, bool late) {
  SimulatedOptions o = cell.options();
  if (late) {
    o.jitter = 0.5 / o.rate;
    o.stall = 5.0 / o.rate;
    o.stall_interval = 0.31;
  }
  SimulatedDevice device(o);
  device.start();
  device.push(Vector3(0.0, 0.0, -1.0));
  auto servo = make_servo();
  const double decay = 2.0 * (o.mass + o.hand.mass) / (o.damping + o.hand.damping), window = 0.5;
  testing::travel(device, servo, 2.5 + 8.0 * decay);
  const double before = device.energy().motors;
  const double travel = testing::travel(device, servo, window);
  return {travel, (device.energy().motors - before) / window};
}

/// Largest wall stiffness without oscillation [N/m]. A travel of two encoder steps counts as rest: friction stops the
/// handle, or it alternates at the edge of an encoder step.
inline double largest_stable(const Cell& cell, bool late) {
  const double still = 2.0 * cell.device->options.encoder_step;
  const auto is_stable = [&](double stiffness) {
    return in_wall(
               cell, [=] { return testing::VirtualWall{.stiffness = stiffness}; }, late)
               .travel <= still;
  };
  return testing::largest_that(is_stable, 0.5 * cell.exact, highest, 0.02);
}

inline double motor_power(const Cell& cell, double stiffness, bool tanked) {
  const testing::VirtualWall wall{.stiffness = stiffness};
  if (!tanked)
    return in_wall(
               cell, [=] { return wall; }, false)
        .power;
  EnergyLimits limits = EnergyLimits::from(cell.device->options.limits);
  limits.delay = cell.delay;
  return in_wall(
             cell, [&] { return testing::Tanked<testing::VirtualWall>{.source = wall, .tank = EnergyTank(limits)}; },
             false)
      .power;
}

/// Largest stiffness [N/m] for which a small motion does not grow, without friction and encoder steps, at a two-sided
/// wall.
inline double largest_linear(const Cell& cell, double guess) {
  SimulatedOptions o = cell.options();
  o.friction = o.encoder_step = 0.0;
  o.limits.peak_force = 1e9;
  // Long enough to detect a stiffness 1 % above the limit: several hundred decay times of the handle.
  const double decay = 2.0 * (o.mass + o.hand.mass) / (o.damping + o.hand.damping);
  const double window = std::max(10.0 / o.rate, decay);
  const auto stable = [&](double stiffness) {
    SimulatedDevice device(o);
    device.start();
    device.push(Vector3(0.0, 0.0, 1e-6));
    testing::VirtualWall wall{.stiffness = stiffness, .one_sided = false};
    testing::travel(device, wall, 5.0 * window);
    const double early = testing::travel(device, wall, window);
    testing::travel(device, wall, 60.0 * window);
    return testing::travel(device, wall, window) <= early * (1.0 + 1e-9);
  };
  return testing::largest_that(stable, 0.5 * guess, 2.0 * guess, 1e-3);
}

/// The same limit from the eigenvalues of handle, zero-order hold and delay line, independent of the simulator's code.
double limit_by_eigenvalues(const SimulatedOptions& device, int delay_ticks);

/// Stiffness of a finite element tissue rendered by a device.
struct TissueRow {
  double youngs_modulus = 0.0;  ///< [Pa]
  double coupling = 0.0;        ///< [N/m] largest stable coupling; `highest` when all are stable
  double rendered = 0.0;        ///< [N/m] coupling and tissue in series, measured at that coupling
  double soft = 0.0;            ///< [N/m] the tissue alone
};
TissueRow measure_tissue(double youngs_modulus, const SimulatedOptions& device);

void write_map(const std::vector<Cell>& cells, const std::string& path);

/// Writes stability.csv and stability.svg; returns the number of figures that differ from their formula.
int measure_haptics(const std::string& folder, std::vector<maps::Grid>& grids);

}  // namespace stability
