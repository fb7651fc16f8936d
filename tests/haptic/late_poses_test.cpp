// Poses that reach the tick late: in a queue, or by a slow connection.
#include <palpate/haptic/detail/stamp_clock.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/haptic_session.hpp>

#include <chrono>

#include "contact/analytic_tissue.hpp"

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Presses 2 mm into the tissue all the time. Stamps are of a clock that was `origin` at the steady clock's epoch; the
/// poses are older than that by a constant delay, and by a part of the time since the first read.
struct LateDevice {
  double delay = 0.0, growth = 0.0, origin = 0.0;
  double first = -1.0;

  ToolState read() noexcept {
    const double now = steady_seconds();
    if (first < 0.0) first = now;
    ToolState state;
    state.position = Vector3(0.0, 0.0, 3e-3);
    state.time = now + origin - delay - growth * (now - first);
    return state;
  }
  Status write(const GatedForce& force) noexcept { return force.status; }
  DeviceLimits limits() const noexcept { return {}; }
  void start() noexcept {}
  void stop() noexcept {}
};
static_assert(HapticDevice<LateDevice>);

LoopReport run(LateDevice device) {
  test::AnalyticTissue tissue(4, 0.2, 1e-3);
  HapticSession session(device, tissue, SphereTool{.radius = 5e-3});
  session.run({.duration = 0.02});  // the loop measures again in every run
  return session.run({.duration = 0.3});
}
double share(const LoopReport& report, StatusFlag flag) {
  return static_cast<double>(report.status[flag]) / static_cast<double>(report.ticks);
}

}  // namespace

TEST_CASE("poses of the steady clock that are constantly late give no force", "[haptic][loop][timing]") {
  for (const double delay : {0.02, 0.5}) {
    const LoopReport late = run({.delay = delay});
    INFO("delay " << delay);
    CHECK(late.peak_force <= 1e-12);  // faded before it could ramp up
    CHECK(share(late, StatusFlag::stale) == 1.0);
  }
}

TEST_CASE("a queue that grows fades the force, whatever the origin of its stamps", "[haptic][loop][timing]") {
  for (const double origin : {0.0, -1e3, 1e6}) {
    const LoopReport late = run({.growth = 0.1, .origin = origin});  // 3 ms late after 30 ms
    INFO("origin " << origin);
    CHECK(share(late, StatusFlag::stale) >= 0.5);
    CHECK(late.peak_force < 1.0);
  }
}

TEST_CASE("punctual poses give their force, whatever the origin of their stamps", "[haptic][loop][timing]") {
  for (const double origin : {0.0, -1e3, 1e6}) {
    const LoopReport punctual = run({.origin = origin});
    INFO("origin " << origin);
    CHECK(punctual.peak_force > 0.0);
    CHECK(share(punctual, StatusFlag::stale) < 0.5);  // on a busy machine some ticks are late
  }
}

TEST_CASE("a tick that knows the present time fades the force of poses that are constantly late", "[haptic][servo]") {
  test::AnalyticTissue tissue(4, 0.2, 1e-3);
  const double full = 2e-3 / (1.0 / 500.0 + 1e-3);
  for (const double delay : {0.0, 0.002, 0.004, 0.02, 1.0, 1e6}) {
    HapticServo servo(tissue, SphereTool{.radius = 5e-3});
    ToolState state;
    std::uint64_t stale = 0;
    for (int k = 0; k < 500; ++k) {
      state.now = 1e-3 * k;
      state.time = state.now - delay;
      state.position = Vector3(0.0, 0.0, 6e-3 - 3e-3 * std::min(1.0, 0.01 * k));
      stale += servo.tick(state).status.has(StatusFlag::stale);
    }
    INFO("delay " << delay);
    const double force = servo.tick(state).force().norm();
    if (delay <= 0.003) {
      CHECK(stale == 0);
      CHECK_THAT(force, WithinRel(full, 1e-3));
    } else {
      CHECK(stale == 500);
      CHECK(force == 0.0);
    }
  }
}

TEST_CASE("a pose that becomes late fades within fade_time, and returns with the ramp", "[haptic][servo]") {
  test::AnalyticTissue tissue(4, 0.2, 1e-3);
  HapticServo servo(tissue, SphereTool{.radius = 5e-3});
  ToolState state;
  double largest_change = 0.0, before = 0.0, lowest = infinity;
  for (int k = 0; k < 600; ++k) {
    state.now = 1e-3 * k;
    state.time = k < 300 || k >= 400 ? state.now : state.now - 0.01;  // still advances by a period per tick
    state.position = Vector3(0.0, 0.0, 6e-3 - 3e-3 * std::min(1.0, 0.01 * k));
    const double force = servo.tick(state).force().norm();
    largest_change = std::max(largest_change, std::abs(force - before));
    before = force;
    if (k >= 330 && k < 400) lowest = std::min(lowest, force);
    if (k == 330) CHECK(force == 0.0);
  }
  CHECK(lowest == 0.0);
  CHECK_THAT(before, WithinRel(2e-3 / (1.0 / 500.0 + 1e-3), 1e-3));
  CHECK(largest_change <= servo.limits().slew_rate * servo.limits().period * (1.0 + 1e-12));
}

TEST_CASE("a stamp of the future, and a present time that is lost, are safe", "[haptic][servo]") {
  test::AnalyticTissue tissue(4, 0.2, 1e-3);
  HapticServo servo(tissue, SphereTool{.radius = 5e-3});
  ToolState state;
  state.position = Vector3(0.0, 0.0, 3e-3);
  for (int k = 0; k < 300; ++k) {
    state.now = 1e-3 * k;
    state.time = state.now + 10.0;
    const double force = servo.tick(state).force().norm();
    if (k > 30) CHECK(force == 0.0);
  }
  servo.reset();
  for (int k = 0; k < 300; ++k) {
    state.time = 1e-3 * k;
    state.now = k % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : state.time;
    CHECK_FALSE(servo.tick(state).status.has(StatusFlag::stale));
  }
  CHECK(servo.tick(state).force().norm() > 0.6);
}

TEST_CASE("the clock of stamps: absolute ages of the steady clock, growth of delay for others", "[haptic][loop]") {
  const double boot = 5e4;
  SECTION("the steady clock itself") {
    detail::StampClock clock;
    for (int k = 0; k < 1000; ++k) {
      const double steady = boot + 1e-3 * k, age = 0.05 + 0.001 * (k % 7);
      CHECK_THAT(clock.now(steady - age, steady), WithinAbs(steady, 1e-9));
    }
  }
  SECTION("another origin: the delay beyond the smallest") {
    detail::StampClock clock;
    int k = 0;
    for (const double delay : {0.02, 0.01, 0.01, 0.03, 0.5}) {
      const double time = k++, stamp = time - delay;
      const double age = clock.now(stamp, boot + time) - stamp;
      CHECK_THAT(age, WithinAbs(delay == 0.02 ? 0.0 : delay - 0.01, detail::StampClock::drift * time + 1e-9));
    }
  }
  SECTION("a clock that is slow by 500 ppm does not age, also in hours") {
    detail::StampClock clock;
    for (int k = 0; k < 20'000; ++k) {
      const double steady = boot + k, stamp = (1.0 - 5e-4) * k;
      CHECK(clock.now(stamp, steady) - stamp <= 1e-9);
    }
  }
  SECTION("a clock that restarts counts from its restart") {
    detail::StampClock clock;
    for (int k = 0; k < 10; ++k) CHECK_THAT(clock.now(100.0 + k, boot + k), WithinAbs(100.0 + k, 1e-9));
    CHECK_THAT(clock.now(0.0, boot + 10.0), WithinAbs(0.0, 1e-9));
    CHECK_THAT(clock.now(0.5, boot + 10.7), WithinAbs(0.7, 1e-3));
  }
  SECTION("no stamp, no time; a lost stamp does not stop the time") {
    detail::StampClock clock;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(clock.now(nan, boot)));
    clock.now(1.0, boot);
    CHECK_THAT(clock.now(nan, boot + 1.0), WithinAbs(2.0, 1e-9));
  }
}
