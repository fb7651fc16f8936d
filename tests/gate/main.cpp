// The force gate against a second implementation of its documentation (gate_model.hpp), over random ticks that hit its
// limits exactly and contain all special values. A small program, so that mutants of the gate compile fast
// (mutants.py).
//   test_gate [--long <ticks>]     default 1e6; 1e9 takes minutes
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/force_gate.hpp>

#include "gate_model.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

using namespace palpate;

int failures = 0;
void expect(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::printf("FAILED: %s\n", what);
}

bool refused(const ForceLimits& limits) {
  try {
    ForceGate gate(limits);
  } catch (const SetupError& error) {
    return error.kind() == SetupErrorKind::bad_argument;
  }
  return false;
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Valid limits that lie exactly on the bounds of the combined checks.
ForceLimits middle() {
  return {1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 1.0, 1.0, 1.0};
}

void check_limits() {
  const auto with = [](double ForceLimits::*which, double value) {
    ForceLimits l{1e-9, 1e9, 1.0, 1.0, 1.0, 1e-9, 1.0, 1.0, 1.0};
    l.*which = value;
    return l;
  };
  for (auto which : {&ForceLimits::peak_force, &ForceLimits::slew_rate, &ForceLimits::ramp_time,
                     &ForceLimits::stale_after, &ForceLimits::fade_time, &ForceLimits::period,
                     &ForceLimits::peak_torque, &ForceLimits::continuous_force, &ForceLimits::heating_time})
    for (double bad :
         {which == &ForceLimits::peak_torque ? -1e-300 : 0.0, -1.0, 0.999e-9, 1.001e9, nan_value, infinity, -infinity})
      expect(refused(with(which, bad)), "an invalid limit is refused");
  for (auto which :
       {&ForceLimits::peak_force, &ForceLimits::ramp_time, &ForceLimits::fade_time, &ForceLimits::stale_after,
        &ForceLimits::peak_torque, &ForceLimits::continuous_force, &ForceLimits::heating_time})
    expect(!refused(with(which, 1e9)), "1e9 is accepted");
  expect(!refused(with(&ForceLimits::ramp_time, 1e-9)), "1e-9 is accepted");
  expect(!refused(with(&ForceLimits::peak_torque, 0.0)), "a torque limit of zero is accepted");
  expect(!refused(middle()), "limits exactly on the bound are accepted");
  ForceLimits l = middle();
  l.slew_rate = 1.0 - 1e-6;
  expect(refused(l), "a fade faster than the slew limit allows is refused");
  l.slew_rate = 1.0 - 0.9e-9;
  expect(!refused(l), "a difference by rounding is accepted");
  l.slew_rate = 1.0 - 1e-9;
  expect(!refused(l), "the largest difference that counts as rounding is accepted");
  l.slew_rate = 1.0 - 1.1e-9;
  expect(refused(l), "a difference larger than rounding is refused");
  l = middle();
  l.fade_time = 0.5;
  expect(refused(l), "slew times fade below the peak is refused");
  l.slew_rate = 2.0;
  expect(!refused(l), "slew times fade equal to the peak is accepted");
  l = middle();
  l.stale_after = 0.75;
  expect(!refused(l), "stale after exactly 1.5 periods is accepted");
  l.stale_after = std::nextafter(0.75, 0.0);
  expect(refused(l), "stale after less is refused");
}

void check_defaults() {
  const ForceLimits d;
  expect(d.peak_force == 3.3 && d.slew_rate == 1650.0 && d.ramp_time == 0.033 && d.stale_after == 0.003 &&
             d.fade_time == 0.020 && d.period == 0.001 && d.peak_torque == 0.0 && d.continuous_force == 1e9 &&
             d.heating_time == 60.0,
         "defaults are the documented ones");
  DeviceLimits device;
  device.peak_force = 8.0;
  device.continuous_force = 2.0;
  device.peak_torque = 0.25;
  const ForceLimits same = ForceLimits::from(device), slow = ForceLimits::from(device, 100.0);
  expect(same.peak_force == 8.0 && same.slew_rate == 4000.0 && same.period == 1e-3 && same.stale_after == 3e-3 &&
             same.peak_torque == 0.25 && same.continuous_force == 2.0,
         "limits are taken from the device");
  expect(slow.period == 0.01 && slow.stale_after == 3.0 * 0.01, "limits scale with the rate");
  expect(ForceLimits::from(device, 4000.0).stale_after == 0.003, "a faster loop does not shorten the stale limit");
  expect(ForceGate(same).limits().peak_force == 8.0, "limits() returns the limits of the gate");
}

struct Random {
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  std::uint64_t next() {  // xorshift64* (Vigna 2016)
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return state * 0x2545f4914f6cdd1du;
  }
  unsigned below(unsigned n) { return static_cast<unsigned>((next() >> 32) % n); }
};

constexpr double specials[] = {nan_value, infinity, -infinity, 1e308, -1e308, 1e300, 5e-324, -5e-324,
                               1e-310,    -0.0,     0.0,       1e154, -1e155, 4.0,   -4.0,   2.0};

double component(Random& r) {
  if (r.below(40) == 0) return specials[r.below(std::size(specials))];
  return 0.25 * (static_cast<double>(r.below(65)) - 32.0);
}
/// Parallel to an axis half of the time, where lengths are exact. Often equal to `before`, so that the ramp completes.
Vector3 force(Random& r, const Vector3& before) {
  if (r.below(4) != 0) return before;
  Vector3 f(component(r), component(r), component(r));
  if (r.below(2) == 0) {
    const int axis = static_cast<int>(r.below(3));
    f = Vector3::Unit(axis).cwiseProduct(Vector3::Constant(f[axis]));
  }
  return f;
}

// Powers of two, so that sums are exact and limits are hit exactly.
constexpr double tick = 1.0 / 1024.0;
constexpr gate::Limits exact{4.0, 2048.0, tick * 32.0, tick * 3.0, tick * 16.0, tick, 0.5, 3.0, tick * 256.0};
// A device without torque, with motors that sustain the peak force.
constexpr gate::Limits plain{4.0, 2048.0, tick * 32.0, tick * 3.0, tick * 16.0, tick, 0.0, 1e9, 4.0};

struct Clock {
  double now = 1.0, stamp = 1.0;

  void advance(Random& r, double& shown, double& shown_stamp) {
    const unsigned dice = r.below(200);
    now += dice < 160   ? tick
           : dice < 170 ? 0.5 * tick
           : dice < 180 ? 1.5 * tick
           : dice < 184 ? 3.0 * tick
           : dice < 187 ? 5.0 * tick
           : dice < 188 ? 40.0 * tick
           : dice < 190 ? 0.0
           : dice < 191 ? -3.0 * tick
                        : tick;
    if (now > 1e6) now = 1.0;
    shown = dice == 199 ? specials[r.below(4)] : now;
    const unsigned other = r.below(200);
    if (other < 150)
      stamp = now;
    else if (other < 176)
      stamp += 0.0;
    else if (other < 190)
      stamp = now - tick * r.below(6);
    else if (other < 196)
      stamp = now + tick * (1.0 + r.below(4));
    shown_stamp = other == 199 ? specials[r.below(4)] : stamp;
  }
};

/// Whether the force was shortened to a length that occurs only with warm motors.
bool is_warm(const Vector3& force, const gate::Limits& limits) {
  const double length = force.norm();
  return length > limits.continuous * (1.0 + 1e-6) && length < 0.98 * limits.peak && std::fmod(length, 0.25) != 0.0;
}

/// A device without time stamps becomes stale no earlier than stale_after.
void check_start() {
  ForceGate gate;
  for (int k = 1; k <= 3; ++k)
    expect(gate.apply({0.0, 0.0, 1.0}, 1e-3 * k, nan_value, true, false).status == StatusFlag::ramping,
           "not stale before stale_after");
  expect(gate.apply({0.0, 0.0, 1.0}, 5e-3, nan_value, true, false).status.has(StatusFlag::stale),
         "stale after stale_after");
}

/// A steady push of twice the continuous force is reduced to the continuous force; after cooling the peak is available.
void check_heating() {
  ForceLimits limits;
  limits.peak_force = 3.0;
  limits.continuous_force = 1.0;
  ForceGate gate(limits);
  const auto push = [&](double newtons, double from, double to) {
    double force = 0.0;
    for (double t = from; t < to; t += 1e-3) force = gate.apply({0.0, 0.0, newtons}, t, t, true, false).force()[2];
    return force;
  };
  expect(std::abs(push(2.0, 0.0, 5.0) - 2.0) < 1e-12, "twice the continuous force is available for seconds");
  expect(std::abs(push(2.0, 5.0, 600.0) - 1.0) < 1e-3, "the steady force is the continuous force");
  gate.reset();
  expect(push(2.0, 600.0, 601.0) < 1.1, "a reset does not change the motor temperature");
  push(0.0, 601.0, 700.0);
  expect(std::abs(push(3.0, 700.0, 701.0) - 3.0) < 1e-12, "the motors cool over time");
}

/// A device that is lost for a while, or whose last state is repeated: motors cool by the elapsed time, counted once.
void check_repeated_input() {
  ForceLimits limits;
  limits.peak_force = 3.0;
  limits.continuous_force = 1.0;
  for (const bool valid : {false, true}) {
    ForceGate repeated(limits), reference(limits);
    const auto both = [&](double newtons, double t) {
      const double a = repeated.apply({0.0, 0.0, newtons}, t, t, true, false).force()[2];
      const double b = reference.apply({0.0, 0.0, newtons}, t, t, true, false).force()[2];
      return std::abs(a - b);
    };
    double t = 0.0;
    for (; t < 20.0; t += 1e-3) both(3.0, t);  // hot
    const double last = t - 1e-3;
    for (int k = 0; k < 4000; ++k, t += 1e-3) {
      repeated.apply(Vector3::Zero(), last, last, valid, false);
      reference.apply(Vector3::Zero(), t, t, valid, false);
    }
    double difference = 0.0;  // of the output forces, after both ramps
    for (const double end = t + 0.2; t < end; t += 1e-3) difference = both(3.0, t);
    expect(difference < 0.05, "a stopped clock does not cool the motors");
  }
}

/// Runs the gate and the model through the same ticks, with an occasional reset of both.
void compare(const gate::Limits& chosen, std::uint64_t ticks) {
  const ForceLimits limits{chosen.peak,   chosen.slew,   chosen.ramp,       chosen.stale,  chosen.fade,
                           chosen.period, chosen.torque, chosen.continuous, chosen.heating};
  ForceGate real(limits);
  gate::Model model(chosen);
  Random r;
  Clock clock;
  Vector3 wanted = Vector3::Zero(), wanted_torque = Vector3::Zero(), before = Vector3::Zero(),
          torque_before = Vector3::Zero();
  std::uint64_t wrong_force = 0, wrong_status = 0, not_finite = 0, too_long = 0, too_fast = 0, rendered = 0;
  std::uint64_t warm = 0;
  bool lossy = false;  // for some ticks valid input is rare
  for (std::uint64_t i = 0; i < ticks; ++i) {
    if (r.below(3000) == 0) {
      real.reset();
      model.reset();
      before.setZero();
      torque_before.setZero();
      if (!(real.last_force() == before)) ++wrong_force;
    }
    if (r.below(1000) == 0) lossy = !lossy;
    double now = 0.0, stamp = 0.0;
    clock.advance(r, now, stamp);
    wanted = force(r, wanted);
    if (!wanted.allFinite() && r.below(4) != 0) wanted = Vector3(0.0, 0.0, 3.0);
    wanted_torque = 0.125 * force(r, 8.0 * wanted_torque);
    if (!wanted_torque.allFinite() && r.below(4) != 0) wanted_torque = Vector3(0.0, 0.25, 0.0);
    const bool valid = r.below(lossy ? 8 : 400) != 0, restart = r.below(300) == 0;
    const GatedForce out = wanted_torque.isZero(0.0) ? real.apply(wanted, now, stamp, valid, restart)
                                                     : real.apply(wanted, wanted_torque, now, stamp, valid, restart);
    const gate::Answer want =
        model.apply({wanted[0], wanted[1], wanted[2]}, {wanted_torque[0], wanted_torque[1], wanted_torque[2]}, now,
                    stamp, valid, restart);

    double difference = 0.0;
    for (int k = 0; k < 3; ++k) {
      difference = std::max(difference, std::abs(out.force()[k] - want.force[static_cast<std::size_t>(k)]));
      difference = std::max(difference, std::abs(out.torque()[k] - want.torque[static_cast<std::size_t>(k)]));
    }
    if (!(difference <= 1e-9) || real.last_force() != out.force() || real.last_torque() != out.torque()) ++wrong_force;
    if (((out.status.bits() ^ want.status) & ~want.unsure) != 0) ++wrong_status;
    model.compare({out.force()[0], out.force()[1], out.force()[2]},
                  {out.torque()[0], out.torque()[1], out.torque()[2]});
    if (!out.force().allFinite() || !out.torque().allFinite()) ++not_finite;
    if (!(out.force().norm() <= chosen.peak * (1.0 + 1e-12))) ++too_long;
    if (!(out.torque().norm() <= chosen.torque * (1.0 + 1e-12))) ++too_long;
    const bool zeroed = (out.status.bits() & (gate::disconnected | gate::non_finite_force)) != 0;
    if (!zeroed && !((out.force() - before).norm() <= chosen.slew * tick * (1.0 + 1e-12))) ++too_fast;
    if (!zeroed && !((out.torque() - torque_before).norm() <=
                     chosen.slew * tick * (chosen.torque / chosen.peak) * (1.0 + 1e-12) + 1e-15))
      ++too_fast;
    if (!out.force().isZero(0.0)) ++rendered;
    if (is_warm(out.force(), chosen)) ++warm;
    before = out.force();
    torque_before = out.torque();
  }
  std::printf(
      "%llu ticks, %.0f %% with a force: %llu forces and %llu statuses differ from the model; %llu not finite, "
      "%llu over the peak, %llu over the slew limit\n",
      static_cast<unsigned long long>(ticks), 100.0 * static_cast<double>(rendered) / static_cast<double>(ticks),
      static_cast<unsigned long long>(wrong_force), static_cast<unsigned long long>(wrong_status),
      static_cast<unsigned long long>(not_finite), static_cast<unsigned long long>(too_long),
      static_cast<unsigned long long>(too_fast));
  expect(wrong_force + wrong_status + not_finite + too_long + too_fast == 0, "the gate conforms to its documentation");
  expect(rendered > ticks / 4, "more than a quarter of the ticks render a force");
  expect(chosen.continuous > chosen.peak || warm > ticks / 100, "motors become warm");
}

}  // namespace

int main(int argc, char** argv) {
  const bool is_long = argc == 3 && std::strcmp(argv[1], "--long") == 0;
  check_limits();
  check_defaults();
  check_start();
  check_heating();
  check_repeated_input();
  const std::uint64_t ticks = is_long ? static_cast<std::uint64_t>(std::atof(argv[2])) : 1'000'000;
  compare(exact, ticks / 2);
  compare(plain, ticks - ticks / 2);
  return failures == 0 ? 0 : 1;
}
