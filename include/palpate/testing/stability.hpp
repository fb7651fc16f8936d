// Checks whether a device with a given servo comes to rest.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/testing/device_laws.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// A wall at z = 0 without state, with an open gate: force stiffness * depth along z. The reference for comparisons
/// with a servo.
struct VirtualWall {
  double stiffness = 500.0;  ///< [N/m]
  bool one_sided = true;     ///< false: pulls as well, so that the loop is linear
  ForceGate gate = open_gate();
  GatedForce force{};

  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept;
};

/// A wall, or any other force computation, followed by an energy tank.
template <class Source>
struct Tanked {
  Source source;
  EnergyTank tank{};
  ForceGate gate = open_gate();
  GatedForce force{};
  std::uint64_t limited = 0;  ///< ticks
  double lowest = infinity;   ///< level of the tank [J]

  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
    const ToolState& tool = tools.front();
    const GatedForce wanted = source.tick(tools).front();
    Status status = wanted.status;
    const Vector3 allowed = tank.limit(wanted.force(), tool.position, tool.time, status);
    force = gate.apply(allowed, tool.time, tool.time, tool.valid, false);
    force.status |= status;
    tank.gave(force.force());
    lowest = std::min(lowest, tank.level());
    if (force.status.has(StatusFlag::energy_injected)) ++limited;
    return {&force, 1};
  }
};

/// One tick: read, compute, write.
template <Servo S>
const GatedForce& tick(SimulatedDevice& device, S& servo) noexcept {
  const ToolState state = device.read();
  const GatedForce& force = servo.tick({&state, 1}).front();
  device.write(force);
  return force;
}

/// Distance between the extremes of the exact z position during `seconds` [m]; infinity if it leaves +-1 m.
template <Servo S>
double travel(SimulatedDevice& device, S& servo, double seconds) noexcept {
  double low = infinity, high = -infinity;
  for (const double end = device.time() + seconds; device.time() < end;) {
    tick(device, servo);
    const double z = device.position()[2];
    if (!(std::abs(z) <= 1.0)) return infinity;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return high - low;
}

/// The largest value in [low, high] for which `holds` is true, assuming it is true below and false above that value: by
/// bisection of the logarithm, to the relative `tolerance`. `low` if it is never true, `high` if it is always true.
template <class Holds>
double largest_that(Holds holds, double low, double high, double tolerance = 0.005) {
  if (!holds(low)) return low;
  if (holds(high)) return high;
  while (high > low * (1.0 + tolerance)) {
    const double middle = std::sqrt(low * high);
    (holds(middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

/// Largest stiffness [N/m] at which a linear loop (no friction, no encoder steps) does not grow: (b + B) / (T/2 + d)
/// for a device damping b, a virtual damping B, a period T and a delay d, if b T / m is small (Hulin et al., IEEE T-CST
/// 2013; Colgate and Schenkel 1997 for d = 0).
double stiffness_limit(double damping, double period, double delay);

inline std::span<const GatedForce> VirtualWall::tick(std::span<const ToolState> tools) noexcept {
  const ToolState& tool = tools.front();
  const double depth = -tool.position[2];
  const Vector3 wanted(0.0, 0.0, one_sided && depth < 0.0 ? 0.0 : stiffness * depth);
  force = gate.apply(wanted, tool.time, tool.time, tool.valid, false);
  return {&force, 1};
}

inline double stiffness_limit(double damping, double period, double delay) {
  return damping / (0.5 * period + delay);
}

}}}  // namespace palpate::testing
