// The OpenHaptics adapter with a fake of the SDK.
#include "device/fakes/hd.hpp"

#include <palpate/device/openhaptics.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/testing/device_laws.hpp>

#include <algorithm>
#include <chrono>
#include <thread>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using palpate::testing::gated;
using test::contains;

namespace {

Vector3 hd_force() {
  const auto& f = fake_hd::sdk().force;
  return Vector3(f[0], f[1], f[2]);
}
OpenHapticsOptions hd_with_torque() {
  OpenHapticsOptions options;
  options.torque = true;
  options.limits = DeviceLimits{.peak_torque = 0.1, .rotational_stiffness = 1.0};
  return options;
}
/// A wall at y = 0 with a gate.
struct GatedWall {
  ForceGate gate{};
  GatedForce force{};
  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
    const ToolState& t = tools.front();
    force = gate.apply(Vector3(0.0, std::max(0.0, -500.0 * t.position[1]), 0.0), t.time, t.time, t.valid, false);
    return {&force, 1};
  }
};
std::string hd_calls() {
  std::string all;
  for (const std::string& c : fake_hd::sdk().calls) all += c + ", ";
  return all;
}
template <class F>
std::string hd_refusal(F f) {
  try {
    f();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("openhaptics: conversion of millimetres, orientation and buttons", "[device][openhaptics]") {
  fake_hd::Scope sdk;
  OpenHapticsDevice device;
  auto& s = fake_hd::sdk();
  s.position = {10.0, -20.0, 30.0};
  s.velocity = {100.0, 0.0, -50.0};
  s.transform = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, -20, 30, 1};  // columns: x -> y, y -> -x
  s.buttons = 0b101;
  device.start();
  const ToolState state = device.read();
  device.write(gated(Vector3(1.0, 2.0, -0.5), Vector3(1.0, 1.0, 1.0)));
  CHECK(state.valid);
  CHECK((state.position - Vector3(0.01, -0.02, 0.03)).norm() < 1e-15);
  CHECK((state.velocity - Vector3(0.1, 0.0, -0.05)).norm() < 1e-15);
  CHECK_THAT(state.orientation[0], WithinAbs(std::sqrt(0.5), 1e-12));  // 90 degrees about z
  CHECK_THAT(state.orientation[3], WithinAbs(std::sqrt(0.5), 1e-12));
  CHECK(state.buttons == 5);
  CHECK(hd_force() == Vector3(1.0, 2.0, -0.5));
  CHECK(s.torque == std::array<double, 3>{});
}

TEST_CASE("openhaptics: torque in newton millimetres for devices with torque motors", "[device][openhaptics]") {
  fake_hd::Scope sdk;
  OpenHapticsDevice device(hd_with_torque());
  device.start();
  device.read();
  device.write(gated(Vector3(0.0, 0.0, 1.0), Vector3(0.01, 0.0, -0.02)));
  CHECK((Vector3(sdk.sdk.torque.data()) - Vector3(10.0, 0.0, -20.0)).norm() < 1e-12);
  device.read();
  CHECK(device.write(gated(Vector3(0.0, 0.0, 1.0), Vector3(0.0, -7.0, 0.0))) == Status(StatusFlag::saturated));
  CHECK((Vector3(sdk.sdk.torque.data()) - Vector3(0.0, -100.0, 0.0)).norm() < 1e-12);
  device.read();
  device.write(gated(Vector3(0.0, 0.0, 1.0), Vector3(0.01, infinity, 0.0)));
  CHECK(sdk.sdk.torque == std::array<double, 3>{});
  CHECK(hd_force() == Vector3::Zero());
}

TEST_CASE("openhaptics: torque without torque limits is refused", "[device][openhaptics]") {
  fake_hd::Scope sdk;
  OpenHapticsOptions options;
  options.torque = true;  // the SDK has no limits for torque
  CHECK_THAT(hd_refusal([&] { OpenHapticsDevice device(options); }), contains("peak torque of 0 N m"));
  options.limits = DeviceLimits{.peak_torque = 0.1};
  CHECK_THAT(hd_refusal([&] { OpenHapticsDevice device(options); }), contains("rotational stiffness of 0"));
}

TEST_CASE("openhaptics: limits are read from the SDK", "[device][openhaptics]") {
  fake_hd::Scope sdk;
  const DeviceLimits limits = OpenHapticsDevice().limits();
  CHECK(limits.peak_force == 3.3);
  CHECK(limits.continuous_force == 0.88);
  CHECK_THAT(limits.stiffness, WithinAbs(500.0, 1e-9));
  CHECK((limits.workspace_low - Vector3(-0.08, -0.06, -0.035)).norm() < 1e-15);
  CHECK((limits.workspace_high - Vector3(0.08, 0.06, 0.035)).norm() < 1e-15);
  for (double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), infinity}) {
    fake_hd::sdk().max_force = bad;
    fake_hd::sdk().calls.clear();
    CHECK_THAT(hd_refusal([] { OpenHapticsDevice device; }), contains("largest force"));
    CHECK(hd_calls() == "init, disable device, ");
  }
  OpenHapticsOptions options;
  options.limits = DeviceLimits{.peak_force = 1.0};
  CHECK(OpenHapticsDevice(options).limits().peak_force == 1.0);
}

TEST_CASE("openhaptics: the error for a missing device contains the SDK's message", "[device][openhaptics]") {
  fake_hd::Scope sdk;
  fake_hd::sdk().init_fails = true;
  CHECK_THAT(hd_refusal([] { OpenHapticsDevice device; }), contains("device fault"));
}

TEST_CASE("openhaptics: satisfies the laws of devices", "[device][openhaptics][laws]") {
  const bool torque = GENERATE(false, true);
  fake_hd::Scope sdk;
  OpenHapticsDevice device(torque ? hd_with_torque() : OpenHapticsOptions());
  // The laws write many times per read; the adapter sends a force only at the end of a frame, so each write has its
  // own.
  struct Framed {
    OpenHapticsDevice& inner;
    ToolState read() noexcept {
      const ToolState s = inner.read();
      inner.write(GatedForce{});
      return s;
    }
    Status write(const GatedForce& force) noexcept {
      inner.read();
      return inner.write(force);
    }
    DeviceLimits limits() const noexcept { return inner.limits(); }
    void start() { inner.start(); }
    void stop() noexcept { inner.stop(); }
  } framed{device};
  testing::DeviceProbe<Framed> framed_probe;
  framed_probe.rendered = [](const Framed&) { return hd_force(); };
  framed_probe.rendered_torque = [](const Framed&) -> Vector3 { return 1e-3 * Vector3(fake_hd::sdk().torque.data()); };
  framed_probe.break_reads = [](Framed&, bool broken) { fake_hd::sdk().broken = broken; };
  CHECK(testing::describe(testing::device_laws(framed, framed_probe, 1000)) == "");
  CHECK(fake_hd::sdk().misuse == 0);
}

TEST_CASE("openhaptics: errors about force only set saturated, others set the force to zero",
          "[device][openhaptics][extreme][D6]") {
  fake_hd::Scope sdk;
  OpenHapticsDevice device;
  device.start();
  for (HDerror code : {HD_WARM_MOTORS, HD_EXCEEDED_MAX_FORCE, HD_EXCEEDED_MAX_FORCE_IMPULSE, HD_EXCEEDED_MAX_VELOCITY,
                       HD_FORCE_ERROR}) {
    fake_hd::fail(code);
    CHECK(device.read().valid);
    fake_hd::fail(code);
    CHECK(device.write(gated(Vector3(0.0, 1.0, 0.0))) == Status(StatusFlag::saturated));
    CHECK(hd_force() == Vector3(0.0, 1.0, 0.0));
  }
  CHECK(device.last_error() == HD_SUCCESS);
  for (int i = 0; i < 12; ++i) fake_hd::fail(HD_EXCEEDED_MAX_FORCE);
  fake_hd::sdk().errors[3] = HD_COMM_ERROR;  // below others on the stack
  CHECK(!device.read().valid);
  CHECK(fake_hd::sdk().errors.empty());
  CHECK(device.write(gated(Vector3(0.0, 1.0, 0.0))).has(StatusFlag::disconnected));
  CHECK(hd_force() == Vector3::Zero());
  CHECK(device.last_error() == HD_COMM_ERROR);
  device.read();
  fake_hd::fail(HD_DEVICE_FAULT);
  CHECK(device.write(gated(Vector3(0.0, 1.0, 0.0))).has(StatusFlag::disconnected));
}

TEST_CASE("openhaptics: positions that are not finite make the state invalid", "[device][openhaptics][extreme][D1]") {
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), infinity}) {
    fake_hd::Scope sdk;
    OpenHapticsDevice device;
    device.start();
    fake_hd::sdk().velocity[1] = bad;
    ToolState state = device.read();
    device.write(gated(Vector3(0.0, 1.0, 0.0)));
    CHECK(state.valid);
    CHECK((std::isnan(state.velocity[0]) && std::isnan(state.velocity[1])));
    CHECK(hd_force()[1] == 1.0);
    fake_hd::sdk().transform[5] = bad;
    CHECK(device.read().orientation == std::array{1.0, 0.0, 0.0, 0.0});
    device.write(gated(Vector3(0.0, 1.0, 0.0)));
    fake_hd::sdk().position[2] = bad;
    state = device.read();
    CHECK(!state.valid);
    CHECK(state.position.allFinite());
    device.write(gated(Vector3(0.0, 1.0, 0.0)));
    CHECK(hd_force() == Vector3::Zero());
  }
}

TEST_CASE("openhaptics: a write without a frame sends nothing, a read without a write ends its frame",
          "[device][openhaptics]") {
  fake_hd::Scope sdk;
  OpenHapticsDevice device;
  device.start();
  CHECK(device.write(gated(Vector3(0.0, 1.0, 0.0))).has(StatusFlag::disconnected));
  device.read();
  device.read();
  device.stop();
  CHECK(fake_hd::sdk().misuse == 0);
  CHECK(!fake_hd::sdk().in_frame);
}

TEST_CASE("openhaptics: the loop begins a frame, reads, sets and ends it, in this order, and stops in order",
          "[device][openhaptics]") {
  fake_hd::Scope sdk;
  fake_hd::sdk().position = {0.0, -2.0, 0.0};  // 2 mm deep: 1 N
  GatedWall wall;
  {
    OpenHapticsDevice device;
    OpenHapticsLoop loop(device, wall);
    loop.start(500);
    while (loop.ticks() < 200) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(loop.alive());
    loop.stop();
    CHECK(!loop.alive());
  }
  auto& s = fake_hd::sdk();
  CHECK(s.rate == 500);
  CHECK(s.misuse == 0);
  CHECK(s.errors_asked_elsewhere == 0);
  const std::string all = hd_calls();
  CHECK(all.starts_with("init, enable, schedule, start scheduler, begin, read, force, end, begin, read, force, end, "));
  CHECK(all.ends_with("begin, read, force, end, stop scheduler, unschedule, disable, disable device, "));
}

TEST_CASE("openhaptics: a lost device ends the loop with zero force", "[device][openhaptics][extreme][D6]") {
  fake_hd::Scope sdk;
  struct Pushes {
    GatedForce force = gated(Vector3(0.0, 2.0, 0.0));
    std::atomic<int> ticks{0};
    std::span<const GatedForce> tick(std::span<const ToolState>) noexcept {
      if (++ticks == 50) fake_hd::sdk().broken = true;
      return {&force, 1};
    }
  } servo;
  OpenHapticsDevice device;
  OpenHapticsLoop loop(device, servo);
  loop.start();
  for (int i = 0; loop.alive() && i < 5000; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(!loop.alive());
  CHECK(hd_force() == Vector3::Zero());
  loop.stop();
  CHECK(servo.ticks == 51);
  CHECK(loop.last_status().has(StatusFlag::disconnected));
  CHECK(device.last_error() == HD_COMM_ERROR);
}

TEST_CASE("openhaptics: a frame that fails while sending ends the loop with zero force, too",
          "[device][openhaptics][extreme][D6]") {
  fake_hd::Scope sdk;
  struct FailsBehind {
    GatedForce force = gated(Vector3(0.0, 2.0, 0.0));
    std::atomic<int> ticks{0};
    std::span<const GatedForce> tick(std::span<const ToolState>) noexcept {
      if (++ticks == 50) fake_hd::fail(HD_COMM_ERROR);  // after the read: the write reports it
      return {&force, 1};
    }
  } servo;
  OpenHapticsDevice device;
  OpenHapticsLoop loop(device, servo);
  loop.start();
  for (int i = 0; loop.alive() && i < 5000; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(!loop.alive());
  CHECK(hd_force() == Vector3::Zero());  // before forces are disabled
  CHECK(servo.ticks == 50);
  loop.stop();
  CHECK(fake_hd::sdk().misuse == 0);
}

TEST_CASE("openhaptics: a loop must be stopped before it is started again, and then counts its ticks from zero",
          "[device][openhaptics]") {
  fake_hd::Scope sdk;
  GatedWall wall;
  OpenHapticsDevice device;
  OpenHapticsLoop loop(device, wall);
  loop.start();
  CHECK_THAT(hd_refusal([&] { loop.start(); }), contains("stop()"));
  CHECK(loop.alive());
  loop.stop();
  fake_hd::sdk().calls_back = false;  // ticks of the first run do not count for the second
  CHECK_THAT(hd_refusal([&] { loop.start(); }), contains("does not call"));
  fake_hd::sdk().calls_back = true;
  loop.start();
  CHECK(loop.ticks() > 0);
  loop.stop();
  const std::string all = hd_calls();
  CHECK(all.find("enable, schedule") != std::string::npos);
  CHECK(fake_hd::sdk().misuse == 0);
}

TEST_CASE("openhaptics: a scheduler that does not call the callback is refused", "[device][openhaptics]") {
  fake_hd::Scope sdk;
  fake_hd::sdk().calls_back = false;
  GatedWall wall;
  OpenHapticsDevice device;
  OpenHapticsLoop loop(device, wall);
  CHECK_THAT(hd_refusal([&] { loop.start(); }), contains("does not call"));
  CHECK(!loop.alive());
  CHECK(hd_calls().ends_with("stop scheduler, unschedule, disable, "));
}
