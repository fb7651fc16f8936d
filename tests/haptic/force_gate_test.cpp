// Tests of single features of the force gate. Random input: force_gate_property_test.cpp.
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/force_gate.hpp>

#include "catch.hpp"

#include <algorithm>

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double period = 1e-3;
const Vector3 two_newtons(0.0, 0.0, 2.0);

/// A gate with a clock: by default valid fresh input every millisecond.
struct GateSession {
  ForceGate gate;
  double now = 10.0;

  explicit GateSession(const ForceLimits& limits = {}) : gate(limits) {}
  GatedForce tick(const Vector3& wanted, bool valid = true, bool restart = false) {
    now += period;
    return gate.apply(wanted, now, now, valid, restart);
  }
  /// Past the ramp.
  GateSession& warm(const Vector3& wanted = two_newtons) {
    for (int i = 0; i < 40; ++i) tick(wanted);
    return *this;
  }
};

template <class Change>
SetupErrorKind refusal(Change change) {
  ForceLimits limits;
  change(limits);
  try {
    ForceGate gate(limits);
  } catch (const SetupError& error) {
    return error.kind();
  }
  return SetupErrorKind::unsupported;  // not refused
}

}  // namespace

TEST_CASE("the ramp starts at zero and rises monotonically to the wanted force", "[haptic][gate][extreme][D3]") {
  GateSession s;
  double before = 0.0;
  for (int i = 0; i < 60; ++i) {
    const GatedForce f = s.tick(two_newtons);
    INFO("tick " << i);
    if (i == 0) CHECK(f.force() == Vector3::Zero());
    CHECK(f.force()[2] >= before);
    CHECK(f.force()[2] - before <= 2.0 / 33.0 + 1e-12);
    CHECK(f.status.has(StatusFlag::ramping) == (f.force()[2] < 2.0));
    before = f.force()[2];
    if (i >= 34) CHECK(f.force() == two_newtons);
    CHECK(f.torque() == Vector3::Zero());
  }
}

TEST_CASE("a huge force ramps as slowly as the peak force", "[haptic][gate][extreme][D3][D7]") {
  GateSession s;
  for (int i = 0; i < 34; ++i) {
    const GatedForce f = s.tick(Vector3(1e308, 1e308, -1e308));
    CHECK(f.status.has(StatusFlag::saturated));
    CHECK_THAT(f.force().norm(), WithinAbs(3.3 * std::min(1.0, i / 33.0), 1e-9));
  }
}

TEST_CASE("forces within the limits pass unchanged and unflagged", "[haptic][gate]") {
  GateSession s;
  s.warm();
  for (const Vector3& f : {Vector3(0, 0, 2), Vector3(0.1, -0.2, 1.5), Vector3(-0.0, 5e-324, 1.2), Vector3(3.2, 0, 0)}) {
    for (int i = 0; i < 5; ++i) s.tick(f);
    const GatedForce out = s.tick(f);
    CHECK(out.force() == f);
    CHECK(out.status.ok());
  }
}

TEST_CASE("a force above the peak is shortened, direction kept", "[haptic][gate][extreme][D7]") {
  GateSession s;
  for (double size : {3.300001, 10.0, 1e10, 1e300}) {
    const Vector3 direction = Vector3(1, -2, 3).normalized();
    s.warm(size * direction);
    const GatedForce f = s.tick(size * direction);
    CHECK(f.status == Status(StatusFlag::saturated));
    CHECK_THAT(f.force().norm(), WithinAbs(3.3, 3.3e-12));
    CHECK(f.force().normalized().dot(direction) >= 1.0 - 1e-12);
  }
}

TEST_CASE("a force that is not finite gives zero immediately and a new ramp", "[haptic][gate][extreme][D1]") {
  for (double bad : {nan_value, infinity, -infinity})
    for (int axis = 0; axis < 3; ++axis) {
      GateSession s;
      s.warm();
      Vector3 wanted = two_newtons;
      wanted[axis] = bad;
      GatedForce f = s.tick(wanted);
      CHECK(f.force() == Vector3::Zero());
      CHECK(f.status == Status(StatusFlag::non_finite_force));
      f = s.tick(two_newtons);
      CHECK(f.force() == Vector3::Zero());
      CHECK(f.status == Status(StatusFlag::ramping));
      CHECK(s.tick(two_newtons).force()[2] <= 2.0 / 33.0 + 1e-12);
    }
}

TEST_CASE("invalid input gives zero in the same tick and a ramp on reconnect", "[haptic][gate][extreme][D6]") {
  GateSession s;
  s.warm();
  for (int i = 0; i < 3; ++i) {
    const GatedForce f = s.tick(two_newtons, false);
    CHECK(f.force() == Vector3::Zero());
    CHECK(f.status == Status(StatusFlag::disconnected));
  }
  CHECK(s.tick(two_newtons).force() == Vector3::Zero());
  double before = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double size = s.tick(two_newtons).force()[2];
    CHECK(size >= before);
    CHECK(size - before <= 2.0 / 33.0 + 1e-12);
    before = size;
  }
  CHECK(before == 2.0);
}

TEST_CASE("input that is valid in every other tick renders zero", "[haptic][gate][extreme][D6]") {
  GateSession s;
  s.warm();
  for (int i = 0; i < 100; ++i) CHECK(s.tick(two_newtons, i % 2 == 1).force() == Vector3::Zero());
}

TEST_CASE("restart ramps from zero, within the slew limit", "[haptic][gate][extreme][D2]") {
  GateSession s;
  s.warm(Vector3(0, 0, 3.3));
  const GatedForce f = s.tick(Vector3(0, 0, 3.3), true, true);
  CHECK_THAT(f.force()[2], WithinAbs(3.3 - 1.65, 1e-12));
  CHECK(f.status == (Status(StatusFlag::ramping) | StatusFlag::slew_limited));
  CHECK(s.tick(Vector3(0, 0, 3.3)).force()[2] <= 0.1 + 1e-12);
}

TEST_CASE("stale input fades to exactly zero and recovers by the ramp", "[haptic][gate][extreme][D5][D6]") {
  enum class Clock { runs, stands, is_nan };
  const auto kind = GENERATE(Clock::runs, Clock::stands, Clock::is_nan);
  const bool nan_stamp = GENERATE(false, true);
  GateSession s;
  s.warm();
  const double stamp = nan_stamp ? nan_value : s.now;
  double before = 2.0;
  for (int i = 1; i <= 30; ++i) {
    const double later = s.now + i * period;
    const double now = kind == Clock::runs ? later : kind == Clock::stands ? s.now : nan_value;
    const GatedForce f = s.gate.apply(two_newtons, now, stamp, true, false);
    INFO("tick " << i);
    CHECK(f.force()[2] <= before);
    CHECK(before - f.force()[2] <= 2.0 / 20.0 + 1e-9);
    before = f.force()[2];
    if (i <= 2) CHECK(f.force()[2] == 2.0);
    if (i >= 4) CHECK(f.status.has(StatusFlag::stale));
    if (i >= 4 && i < 23) CHECK(f.force()[2] < 2.0);
    if (i >= 24) CHECK(f.force() == Vector3::Zero());
  }
  s.now += 0.030;
  const Vector3 first = s.tick(two_newtons).force();  // the stall of the stopped clock ends here
  CHECK(first == Vector3::Zero());
  s.warm();
  CHECK(s.tick(two_newtons).force() == two_newtons);
}

TEST_CASE("a huge force fades, too", "[haptic][gate][extreme][D5][D7]") {
  GateSession s;
  s.warm(Vector3(1e300, 0, 0));
  const double stamp = s.now;
  for (int i = 1; i <= 24; ++i) {
    const Vector3 f = s.gate.apply(Vector3(1e300, 0, 0), stamp + i * period, stamp, true, false).force();
    CHECK(f[0] <= 3.3 * std::max(0.0, 1.0 - (i - 3) / 20.0) + 1e-9);
  }
  CHECK(s.gate.last_force() == Vector3::Zero());
}

TEST_CASE("input with a constant delay: fresh below stale_after, faded above", "[haptic][gate][extreme][D5]") {
  for (const auto& [delay, renders] : {std::pair(0.0, true), std::pair(0.002, true), std::pair(0.010, false)}) {
    ForceGate gate;
    Vector3 f = Vector3::Zero();
    for (int i = 0; i < 200; ++i) f = gate.apply(two_newtons, i * period, i * period - delay, true, false).force();
    CHECK(f == (renders ? two_newtons : Vector3(Vector3::Zero())));
  }
}

TEST_CASE("stamps in the future or of another clock render zero", "[haptic][gate][extreme][D6]") {
  for (double offset : {1.0, -1.0, 1e300, -1e300, infinity, -infinity}) {
    ForceGate gate;
    gate.apply(two_newtons, 0.0, 0.0, true, false);
    double most = 0.0;
    for (int i = 1; i < 200; ++i) {
      const double now = i * period;
      const Vector3 f = gate.apply(two_newtons, now, now + offset, true, false).force();
      if (i > 30) most = std::max(most, f.norm());
    }
    INFO(offset);
    CHECK(most == 0.0);
  }
}

TEST_CASE("a stall reduces the gain for the time beyond stale_after, counts once, and allows no jump",
          "[haptic][gate][extreme][D5]") {
  struct Case {
    double stall, gain;
    bool stale;
  };
  for (const Case& c :
       {Case{0.002, 1.0, false}, Case{0.005, 0.9, true}, Case{0.020, 0.15, true}, Case{0.200, 0.0, true}}) {
    GateSession s;
    s.warm(Vector3(0, 0, 3.0));
    int missed = 0;
    Vector3 before = s.gate.last_force();
    s.now += c.stall - period;
    for (int i = 0; i < 60; ++i) {
      const GatedForce f = s.tick(Vector3(0, 0, 3.0));
      missed += f.status.has(StatusFlag::deadline_missed) ? 1 : 0;
      CHECK((f.force() - before).norm() <= 1.65 + 1e-12);
      if (i == 0) CHECK(f.status.has(StatusFlag::stale) == c.stale);
      if (i == 0) CHECK_THAT(f.force()[2], WithinAbs(std::max(3.0 * c.gain, 3.0 - 1.65), 1e-9));
      if (i == 1) CHECK(f.force()[2] <= 3.0 * c.gain + 1e-9);
      before = f.force();
    }
    INFO("stall " << c.stall);
    CHECK(missed == 1);
    CHECK(before[2] == 3.0);
  }
}

TEST_CASE("the change per tick is limited, also with faulty clocks", "[haptic][gate][extreme][D2][D8]") {
  GateSession s;
  s.warm(Vector3(3.3, 0, 0));
  SECTION("a full reversal takes four ticks") {
    for (int i = 1; i <= 4; ++i) {
      const GatedForce f = s.tick(Vector3(-3.3, 0, 0));
      CHECK_THAT(f.force()[0], WithinAbs(3.3 - 1.65 * i, 1e-9));  // the clock itself rounds to 2e-12
      if (i < 4) CHECK(f.status == Status(StatusFlag::slew_limited));
    }
    const GatedForce f = s.tick(Vector3(-3.3, 0, 0));
    CHECK(f.force()[0] == -3.3);
    CHECK(f.status.ok());
  }
  SECTION("half a period allows half the change") {
    s.now += 0.5 * period;
    const GatedForce f = s.gate.apply(Vector3(-3.3, 0, 0), s.now, s.now, true, false);
    CHECK_THAT(f.force()[0], WithinAbs(3.3 - 0.825, 1e-9));
  }
  SECTION("a clock that stands still, runs backwards or is not finite counts as one period") {
    for (double now : {s.now, s.now - 5.0, nan_value, infinity, -infinity, -1e308}) {
      ForceGate gate = s.gate;
      const Vector3 f = gate.apply(Vector3(-3.3, 0, 0), now, s.now + period, true, false).force();
      INFO(now);
      CHECK((f - s.gate.last_force()).norm() <= 1.65 + 1e-12);
    }
  }
}

TEST_CASE("after a clock is set back the force returns within a ramp", "[haptic][gate][extreme][D5]") {
  GateSession s;
  s.warm();
  s.now = -1000.0;
  s.warm();
  CHECK(s.tick(two_newtons).force() == two_newtons);
}

TEST_CASE("limits are exact: no flag at a limit, a flag just beyond it", "[haptic][gate]") {
  ForceLimits limits;  // powers of two: every sum below is exact
  limits.peak_force = 4.0;
  limits.period = 0x1p-10;
  limits.slew_rate = 1024.0;  // 1 N per tick
  limits.stale_after = 0x1p-8;
  limits.ramp_time = limits.fade_time = 0x1p-5;
  const double tick = limits.period;
  const Vector3 one(1.0, 0.0, 0.0);
  ForceGate warm(limits);
  for (int i = 0; i < 40; ++i) warm.apply(one, i * tick, i * tick, true, false);
  const double last = 39.0 * tick;
  const auto next = [&](double now, double stamp, const Vector3& wanted = Vector3(1.0, 0.0, 0.0)) {
    ForceGate gate = warm;
    return gate.apply(wanted, now, stamp, true, false);
  };
  constexpr double bit = 0x1p-30;
  CHECK(next(last + 1.5 * tick, last + 1.5 * tick).status.ok());
  CHECK(next(last + 1.5 * tick + bit, last + 1.5 * tick).status == Status(StatusFlag::deadline_missed));
  CHECK(next(last + tick, last + tick - limits.stale_after).status.ok());
  CHECK(next(last + tick, last + tick - limits.stale_after - bit).status == Status(StatusFlag::stale));
  CHECK(next(last + tick, last + tick, 2.0 * one).status.ok());
  CHECK(next(last + tick, last + tick, (2.0 + bit) * one).status == Status(StatusFlag::slew_limited));

  const auto future = [&](double ahead) {  // all stamps are ahead of the clock by the same time
    ForceGate gate(limits);
    GatedForce f;
    for (int i = 0; i < 80; ++i) f = gate.apply(one, i * tick, i * tick + ahead, true, false);
    return f.force();
  };
  CHECK(future(limits.stale_after) == one);
  CHECK(future(limits.stale_after + bit) == Vector3::Zero());
}

TEST_CASE("nothing is stale before the first stale_after has passed", "[haptic][gate]") {
  ForceGate gate;
  for (int i = 0; i < 3; ++i) {
    const GatedForce f = gate.apply(two_newtons, i * period, nan_value, true, false);
    CHECK(f.status == Status(StatusFlag::ramping));
  }
  gate.apply(two_newtons, 3 * period, nan_value, true, false);
  CHECK(gate.apply(two_newtons, 4 * period, nan_value, true, false).status.has(StatusFlag::stale));
}

TEST_CASE("an old stamp does not become fresh when invalid ones are in between", "[haptic][gate][extreme][D5]") {
  for (double other : {nan_value, infinity, 1e300}) {
    GateSession s;
    s.warm();
    for (int i = 0; i < 60; ++i) s.gate.apply(two_newtons, s.now, i % 2 == 0 ? other : s.now, true, false);
    INFO(other);
    CHECK(s.gate.last_force() == Vector3::Zero());
  }
}

TEST_CASE("a stall is detected after a clock reading that is not finite", "[haptic][gate][extreme][D5]") {
  for (double other : {nan_value, infinity, -infinity}) {
    GateSession s;
    s.warm();
    s.gate.apply(two_newtons, other, s.now + period, true, false);
    s.now += 0.1;
    const GatedForce f = s.tick(two_newtons);
    INFO(other);
    CHECK(f.status.has(StatusFlag::deadline_missed));
    CHECK(f.status.has(StatusFlag::stale));
  }
}

TEST_CASE("reset restores the initial state", "[haptic][gate]") {
  GateSession s;
  s.warm();
  s.gate.reset();
  CHECK(s.gate.last_force() == Vector3::Zero());
  CHECK(s.tick(two_newtons).force() == Vector3::Zero());
  CHECK(s.gate.limits().peak_force == 3.3);
}

TEST_CASE("limits follow the device and the rate", "[haptic][gate]") {
  DeviceLimits device;
  device.peak_force = 8.5;
  const ForceLimits fast = ForceLimits::from(device);
  CHECK(fast.peak_force == 8.5);
  CHECK(fast.slew_rate == 4250.0);
  CHECK(fast.stale_after == 0.003);
  const ForceLimits slow = ForceLimits::from(device, 300.0);
  CHECK_THAT(slow.stale_after, WithinAbs(0.01, 1e-15));
  CHECK_NOTHROW(ForceGate(fast));
  CHECK_NOTHROW(ForceGate(slow));
  device.peak_force = 0.0;
  CHECK_THROWS_AS(ForceGate(ForceLimits::from(device)), SetupError);
  CHECK_THROWS_AS(ForceGate(ForceLimits::from(DeviceLimits{}, 0.0)), SetupError);
}

TEST_CASE("invalid limits are refused", "[haptic][gate]") {
  constexpr auto bad = SetupErrorKind::bad_argument;
  for (double value : {0.0, -1.0, nan_value, infinity, -infinity, 1e-10, 1e10}) {
    INFO(value);
    CHECK(refusal([&](ForceLimits& l) { l.peak_force = value; }) == bad);
    CHECK(refusal([&](ForceLimits& l) { l.slew_rate = value; }) == bad);
    CHECK(refusal([&](ForceLimits& l) { l.ramp_time = value; }) == bad);
    CHECK(refusal([&](ForceLimits& l) { l.stale_after = value; }) == bad);
    CHECK(refusal([&](ForceLimits& l) { l.fade_time = value; }) == bad);
    CHECK(refusal([&](ForceLimits& l) { l.period = value; }) == bad);
  }
  CHECK(refusal([](ForceLimits& l) { l.slew_rate = 164.0; }) == bad);  // slower than the fade
  CHECK(refusal([](ForceLimits& l) { l.slew_rate = 165.0; }) == SetupErrorKind::unsupported);
  CHECK(refusal([](ForceLimits& l) {
          l.fade_time = 1.0;
          l.slew_rate = l.peak_force * (1.0 - 1e-9);
        }) == SetupErrorKind::unsupported);                               // exactly at the bound
  CHECK(refusal([](ForceLimits& l) { l.stale_after = 0.0014; }) == bad);  // every tick would be stale
  CHECK(refusal([](ForceLimits& l) { l.stale_after = 0.0015; }) == SetupErrorKind::unsupported);
}
