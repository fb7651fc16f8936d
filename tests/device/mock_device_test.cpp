// Trajectories, faults and clocks of the mock device.
#include <palpate/device/mock_device.hpp>
#include <palpate/testing/device_laws.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using palpate::testing::gated;

namespace {

std::vector<ToolState> read_all(int count, const MockOptions& options) {
  MockDevice device(trajectory::poke(), options);
  std::vector<ToolState> states;
  for (int i = 0; i < count; ++i) states.push_back(device.read());
  return states;
}

}  // namespace

TEST_CASE("a trajectory passes its waypoints, at rest, without overshoot", "[device][trajectory]") {
  const Vector3 a(0, 0, 0.02), b(0.01, 0, -0.01), c(0.01, 0.03, 0);
  const Trajectory path({{0.5, a}, {1.0, b}, {3.0, c}});
  CHECK(path(-1.0) == a);
  CHECK(path(0.5) == a);
  CHECK((path(1.0) - b).norm() < 1e-15);
  CHECK(path(3.0) == c);
  CHECK(path(1e300) == c);
  CHECK(path(std::numeric_limits<double>::quiet_NaN()).allFinite());
  CHECK(path.duration() == 3.0);
  CHECK((path(0.75) - 0.5 * (a + b)).norm() < 1e-15);
  for (double t : {-1.0, 0.5, 1.0, 3.0, 10.0}) CHECK(path.velocity(t).norm() < 1e-12);
  double worst = 0.0, beyond = 0.0;
  for (double t = 0.0; t < 3.5; t += 1e-3) {
    const double h = 1e-6;
    worst = std::max(worst, (path.velocity(t) - (path(t + h) - path(t - h)) / (2.0 * h)).norm());
    if (t > 0.5 && t < 1.0) beyond = std::max(beyond, (path(t) - a).norm() + (path(t) - b).norm() - (a - b).norm());
  }
  CHECK(worst < 1e-6);
  CHECK(beyond < 1e-15);
}

TEST_CASE("invalid trajectories and devices are refused", "[device][trajectory]") {
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  const Vector3 x = Vector3::Zero();
  CHECK_THROWS_AS(Trajectory({}), SetupError);
  CHECK_THROWS_AS(Trajectory({{0.0, x}, {0.0, x}}), SetupError);
  CHECK_THROWS_AS(Trajectory({{1.0, x}, {0.0, x}}), SetupError);
  CHECK_THROWS_AS(Trajectory({{nan_value, x}}), SetupError);
  CHECK_THROWS_AS(Trajectory({{0.0, Vector3(0, nan_value, 0)}}), SetupError);
  CHECK_THROWS_AS(trajectory::poke({.approach = 0.0}), SetupError);
  MockOptions options;
  for (double bad : {0.0, -1.0, nan_value, infinity}) {
    options.rate = bad;
    CHECK_THROWS_AS(MockDevice(trajectory::poke(), options), SetupError);
  }
  options = {};
  options.limits.peak_force = nan_value;
  CHECK_THROWS_AS(MockDevice(trajectory::poke(), options), SetupError);
}

TEST_CASE("poke moves in, waits, moves back, the given number of times", "[device][trajectory]") {
  const Vector3 from(0, 0, 0.01), to(0, 0, -0.02);
  const Trajectory path =
      trajectory::poke({.from = from, .to = to, .approach = 1, .hold = 2, .retreat = 3, .pause = 4, .times = 2});
  CHECK(path.duration() == 20.0);
  for (double start : {0.0, 10.0}) {
    CHECK((path(start) - from).norm() < 1e-15);
    for (double t : {1.0, 2.0, 3.0}) CHECK((path(start + t) - to).norm() < 1e-15);
    for (double t : {6.0, 8.0, 10.0}) CHECK((path(start + t) - from).norm() < 1e-15);
  }
  CHECK(trajectory::poke({.times = 0}).duration() == 0.0);
}

TEST_CASE("simulated time: one period per read, the same in every run", "[device][mock]") {
  MockOptions options;
  options.rate = 500.0;
  const auto first = read_all(2000, options), second = read_all(2000, options);
  const Trajectory path = trajectory::poke();
  for (std::size_t i = 0; i < first.size(); ++i) {
    REQUIRE(first[i].time == static_cast<double>(i) / 500.0);
    REQUIRE(first[i].position == path(first[i].time));
    REQUIRE(first[i].velocity == path.velocity(first[i].time));
    REQUIRE(first[i].position == second[i].position);
    REQUIRE(first[i].valid);
  }
}

TEST_CASE("a path without velocity gives states without velocity", "[device][mock]") {
  MockDevice device([](double t) { return Vector3(t, 0, 0); });
  const ToolState s = device.read();
  CHECK(s.velocity.array().isNaN().all());
  CHECK(s.position == Vector3::Zero());
  CHECK(device.read().position == Vector3(1e-3, 0, 0));
}

TEST_CASE("faults begin and end on schedule", "[device][mock][extreme][D1][D2][D5][D6]") {
  using Kind = DeviceFault::Kind;
  MockOptions options;
  options.faults = {{.kind = Kind::invalid_read, .first = 10, .count = 2},
                    {.kind = Kind::nan_position, .first = 20},
                    {.kind = Kind::infinite_position, .first = 30},
                    {.kind = Kind::teleport, .first = 40, .offset = Vector3(1, 0, 0)},
                    {.kind = Kind::stall, .first = 50, .count = 2, .seconds = 0.1},
                    {.kind = Kind::frozen, .first = 60, .count = 3}};
  const auto s = read_all(100, options);
  const auto good = read_all(100, {});
  CHECK(s[9].valid);
  CHECK_FALSE(s[10].valid);
  CHECK_FALSE(s[11].valid);
  CHECK(s[12].valid);
  CHECK(std::isnan(s[20].position[1]));
  CHECK(s[21].position == good[21].position);
  CHECK(s[30].position[1] == infinity);
  CHECK(s[40].position == good[40].position + Vector3(1, 0, 0));
  CHECK(s[41].position == good[41].position);
  CHECK_THAT(s[50].time - s[49].time, WithinAbs(0.101, 1e-12));
  CHECK_THAT(s[51].time - s[50].time, WithinAbs(0.101, 1e-12));
  CHECK_THAT(s[52].time - s[51].time, WithinAbs(0.001, 1e-12));
  for (std::size_t i = 60; i < 63; ++i)
    CHECK((s[i].time == s[59].time && s[i].position == s[59].position && s[i].valid));
  CHECK_THAT(s[63].time - s[59].time, WithinAbs(0.004, 1e-12));
}

TEST_CASE("wall clock: time follows the clock and a stall has its duration", "[device][mock][timing]") {
  MockOptions options;
  options.clock = DeviceClock::wall;
  options.faults = {{.kind = DeviceFault::Kind::stall, .first = 1, .seconds = 0.02}};
  const auto s = read_all(3, options);
  CHECK(s[0].time >= 0.0);
  CHECK(s[1].time - s[0].time >= 0.02);
  CHECK(s[2].time >= s[1].time);
}

TEST_CASE("motors render zero before start, after stop and while unplugged", "[device][mock][extreme][D6]") {
  MockDevice device(trajectory::poke());
  const Vector3 f(0, 0, 1), none = Vector3::Zero();
  device.read();
  CHECK(device.write(gated(f)).ok());
  CHECK(device.last_force() == none);
  device.start();
  device.write(gated(f));
  CHECK(device.last_force() == f);
  device.unplug();
  CHECK_FALSE(device.read().valid);
  CHECK(device.last_force() == none);
  CHECK(device.write(gated(f)) == Status(StatusFlag::disconnected));
  CHECK(device.last_force() == none);
  device.unplug(false);
  CHECK(device.read().valid);
  device.write(gated(10.0 * f));
  CHECK(device.last_force() == 3.3 * f);
  device.stop();
  CHECK(device.last_force() == none);
  CHECK(device.peak_force() == 3.3);
}
