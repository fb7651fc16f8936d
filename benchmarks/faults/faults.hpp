// Faults injected into a session with a tissue that is simulated at a lower rate, and their effect on the rendered
// force.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/moving/implicit.hpp>

#include <cmath>

namespace faults {

using namespace palpate;

inline constexpr double sphere = 0.012, tick = 1e-3, duration = 6.0;
inline constexpr double stale_after = 0.5005;  // not a multiple of the tick, so that rounding has no effect
inline const Vector3 pad_size(0.06, 0.06, 0.03);

using Pad = HapticFEModel<Tet4, NeoHookean, Implicit<Newton>>;

inline Pad make_pad(double step) {
  return Pad(box_tet4(pad_size, {5, 5, 3}), Scene().fix("z0").touch("z1"), NeoHookean{5e3, 0.45, 1000.0}, {},
             {.step = step});
}

/// A fault that occurs once every second, half a second after the start of the second.
struct Fault {
  double tissue_stall = 0.0;  ///< [s] delay of the tissue's next step
  double device_stall = 0.0;  ///< [s] duration without ticks
  bool bad_input = false;     ///< one pose that is NaN, one state that the device cannot read

  /// Whether the fault makes forces fade. If the hand moves during a fade, it may receive more energy than it supplied.
  bool fades() const { return tissue_stall > stale_after || device_stall > ForceLimits{}.stale_after || bad_input; }
};

struct Outcome {
  double peak = 0.0;       ///< [N] longest force rendered
  double step = 0.0;       ///< [N] largest change of the rendered force between ticks, except zeroing on bad input
  double raw_step = 0.0;   ///< [N] the same for the force before the gate
  double given = 0.0;      ///< [J] largest total energy given to the hand, less the dissipation of the device's damping
  double taken = 0.0;      ///< [J] total energy taken from the hand at the end, when the tool is free again
  double tank = infinity;  ///< [J] lowest level of the energy tank
  int ticks = 0, not_finite = 0;
  int stale = 0, missed = 0, disconnected = 0, bad = 0;                  ///< ticks with these flags
  int stale_due = 0, missed_due = 0, disconnected_due = 0, bad_due = 0;  ///< ticks that must have them
  double last_force = 0.0;  ///< [N] force one second after the last fault, at the same depth as without faults
};

/// Depth of the tool [m]: 8 mm with an oscillation of 1.5 mm at 2 Hz; out of the tissue in the last second.
inline double depth_at(double t) {
  if (t > duration - 1.0) return -0.002;
  const double in = std::min(1.0, t / 0.4), out = std::clamp((duration - 1.0 - t) / 0.3, 0.0, 1.0);
  return -0.002 + std::min(in, out) * (0.010 + 0.0015 * std::sin(4.0 * 3.141592653589793 * t));
}

inline const DeviceLimits device{.peak_force = 8.0, .continuous_force = 8.0, .stiffness = 1000.0};

inline ServoOptions session_options() {
  return {.stale_tissue_after = stale_after, .devices = {device}};
}

/// Runs a session in simulated time, so that the outcome is the same on every machine; threads are tested separately.
inline Outcome run(const Fault& fault, double tissue_step) {
  Pad tissue = make_pad(tissue_step);
  ServoOptions options = session_options();
  options.limit_energy = true;
  HapticServo servo(tissue, SphereTool{.radius = sphere}, options);
  const ForceLimits limits = ForceLimits::from(device);
  PassivityObserver hand;
  const double damping = EnergyLimits::from(device).damping;
  double damped = 0.0;
  Outcome out;
  double next_step = 0.0, news = 0.0, quiet_until = -1.0;
  double last_tick = -tick;
  Vector3 before = Vector3::Zero(), raw_before = Vector3::Zero();
  int second = -1;
  bool was_zeroed = false;
  for (int k = 0; k < static_cast<int>(duration / tick); ++k) {
    const double t = k * tick;
    const bool strikes = t >= 0.5 && t < duration - 1.5 && static_cast<int>(t - 0.5 + 1e-9) != second;
    if (strikes) {
      second = static_cast<int>(t - 0.5 + 1e-9);
      next_step += fault.tissue_stall;
      if (fault.device_stall > 0.0) quiet_until = t + fault.device_stall;
    }
    bool has_news = false;
    while (next_step <= t + 1e-12) {
      tissue.advance();
      next_step += tissue.step();
      has_news = true;
    }
    if (t < quiet_until - 1e-9) continue;
    if (has_news || k == 0) news = t;
    ToolState state;
    state.time = t;
    state.position = {0.5 * pad_size[0], 0.5 * pad_size[1], pad_size[2] + sphere - depth_at(t)};
    const int since = static_cast<int>(std::lround((t - 0.5 - second) / tick));
    const bool not_a_number = fault.bad_input && second >= 0 && since == 100,
               unreadable = fault.bad_input && second >= 0 && since == 300;
    if (not_a_number) state.position[1] = std::numeric_limits<double>::quiet_NaN();
    if (unreadable) state.valid = false;

    const GatedForce force = servo.tick({&state, 1})[0];
    const bool is_good = state.valid && state.position.allFinite();
    if (is_good) {
      const auto step = hand.moved(state.position, t);
      if (step.time > 0.0) damped += damping * step.squared_path / step.time;
    } else {
      hand.forget();
    }
    hand.gave(force.force());

    ++out.ticks;
    out.not_finite += !force.force().allFinite();
    out.peak = std::max(out.peak, force.force().norm());
    if (!unreadable && !was_zeroed) out.step = std::max(out.step, (force.force() - before).norm());
    if (!unreadable && !was_zeroed && k > 0)
      out.raw_step = std::max(out.raw_step, (servo.tick_view().contact_force() - raw_before).norm());
    was_zeroed = unreadable;
    before = force.force();
    raw_before = servo.tick_view().contact_force();
    out.given = std::max(out.given, hand.given() - damped);
    out.tank = std::min(out.tank, servo.tick_view().energy()->level());
    out.stale += force.status.has(StatusFlag::stale);
    out.missed += force.status.has(StatusFlag::deadline_missed);
    out.disconnected += force.status.has(StatusFlag::disconnected);
    out.bad += force.status.has(StatusFlag::non_finite_input);
    // Flags required by the documentation: no update for longer than both limits; a gap longer than the gate's limit.
    const double dt = t - last_tick;
    out.stale_due += t - news > stale_after + limits.stale_after + 1e-9 || dt > limits.stale_after + 1e-9;
    out.missed_due += dt > 1.5 * tick;
    out.disconnected_due += unreadable;
    out.bad_due += not_a_number;
    if (is_good) last_tick = t;
    if (std::abs(t - 4.6) < 0.5 * tick) out.last_force = force.force().norm();
  }
  out.taken = damped - hand.given();
  return out;
}

}  // namespace faults
