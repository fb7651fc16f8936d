// The Force Dimension adapter with a fake of the SDK.
#include "device/fakes/dhdc.hpp"

#include <palpate/device/force_dimension.hpp>
#include <palpate/testing/device_laws.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using palpate::testing::gated;

namespace {

Vector3 dhd_force() {
  return Vector3(fake_dhd::sdk().force.data());
}

ForceDimensionOptions dhd_with_torque() {
  ForceDimensionOptions options;
  options.torque = true;
  options.limits.peak_torque = 0.1;
  options.limits.rotational_stiffness = 1.0;
  return options;
}

template <class F>
std::string dhd_refusal(F f) {
  try {
    f();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("force dimension: states are passed on in SI units", "[device][force_dimension]") {
  fake_dhd::Scope sdk;
  ForceDimensionDevice device;
  sdk.sdk.position = {0.01, -0.02, 0.03};
  sdk.sdk.velocity = {0.1, 0.2, -0.3};
  sdk.sdk.rotation[0][0] = sdk.sdk.rotation[1][1] = 0.0;
  sdk.sdk.rotation[1][0] = 1.0;
  sdk.sdk.rotation[0][1] = -1.0;  // 90 degrees about z
  sdk.sdk.buttons = 9;
  const ToolState s = device.read();
  CHECK(s.valid);
  CHECK(s.position == Vector3(0.01, -0.02, 0.03));
  CHECK(s.velocity == Vector3(0.1, 0.2, -0.3));
  CHECK_THAT(s.orientation[3], WithinAbs(std::sqrt(0.5), 1e-12));
  CHECK(s.buttons == 9);
}

TEST_CASE("force dimension: satisfies the laws of devices", "[device][force_dimension][laws]") {
  for (const bool torque : {false, true}) {
    fake_dhd::Scope sdk;
    ForceDimensionDevice device(torque ? dhd_with_torque() : ForceDimensionOptions());
    testing::DeviceProbe<ForceDimensionDevice> probe;
    probe.rendered = [](const ForceDimensionDevice&) { return dhd_force(); };
    probe.rendered_torque = [&](const ForceDimensionDevice&) { return Vector3(sdk.sdk.torque.data()); };
    probe.break_reads = [&](ForceDimensionDevice&, bool broken) { sdk.sdk.read_answer = broken ? -1 : 0; };
    CHECK(testing::describe(testing::device_laws(device, probe, 1000)) == "");
  }
}

TEST_CASE("force dimension: return values of the SDK", "[device][force_dimension][extreme][D6]") {
  fake_dhd::Scope sdk;
  ForceDimensionDevice device;
  device.start();
  CHECK(sdk.sdk.max_force == 3.0);
  const Vector3 force(0.0, 1.0, 0.0);
  sdk.sdk.read_answer = sdk.sdk.velocity_answer = 1;  // the time guard: data are fresh
  CHECK(device.read().valid);
  CHECK(device.write(gated(force)).ok());
  sdk.sdk.force_answer = 2;
  CHECK(device.write(gated(force)) == Status(StatusFlag::saturated));
  CHECK(dhd_force() == force);
  sdk.sdk.force_answer = -1;
  CHECK(device.write(gated(force)) == Status(StatusFlag::disconnected));
  CHECK(device.last_force() == Vector3::Zero());
  sdk.sdk.force_answer = 0;
  CHECK(device.write(gated(force)).has(StatusFlag::disconnected));  // until a read is valid again
  CHECK(dhd_force() == Vector3::Zero());
  sdk.sdk.velocity_answer = -1;
  const ToolState s = device.read();
  CHECK(s.valid);
  CHECK(std::isnan(s.velocity[0]));
  CHECK(device.write(gated(force)).ok());
  sdk.sdk.position[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(!device.read().valid);
  CHECK(device.write(gated(force)).has(StatusFlag::disconnected));
  CHECK(dhd_force() == Vector3::Zero());
}

TEST_CASE("force dimension: every write sends a force, also a zero and when stopped", "[device][force_dimension]") {
  fake_dhd::Scope sdk;
  {
    ForceDimensionDevice device;
    device.read();
    device.write(gated(Vector3(0.0, 1.0, 0.0)));  // not started
    CHECK(sdk.sdk.forces_sent == 1);
    CHECK(dhd_force() == Vector3::Zero());
    device.start();
    device.write(GatedForce{});
    device.write(gated(Vector3(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0)));
    CHECK(sdk.sdk.forces_sent == 3);
    CHECK(dhd_force() == Vector3::Zero());
    device.write(gated(Vector3(0.0, 1.0, 0.0)));
    CHECK(dhd_force()[1] == 1.0);
  }
  CHECK(dhd_force() == Vector3::Zero());
  CHECK(sdk.sdk.calls == std::vector<std::string>{"open", "on", "off", "close 4"});
}

TEST_CASE("force dimension: torque for devices with torque motors, and only finite", "[device][force_dimension]") {
  fake_dhd::Scope sdk;
  ForceDimensionDevice device(dhd_with_torque());
  device.start();
  device.read();
  device.write(gated(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 0.02, 0.0)));
  CHECK(sdk.sdk.torque == std::array{0.0, 0.02, 0.0});
  CHECK(device.write(gated(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 5.0, 0.0))) == Status(StatusFlag::saturated));
  CHECK_THAT(sdk.sdk.torque[1], WithinAbs(0.1, 1e-15));
  device.write(gated(Vector3(1.0, 0.0, 0.0), Vector3(0.0, infinity, 0.0)));
  CHECK(sdk.sdk.torque == std::array{0.0, 0.0, 0.0});
  CHECK(dhd_force() == Vector3::Zero());
  ForceDimensionOptions unlimited;
  unlimited.torque = true;
  CHECK_THAT(dhd_refusal([&] { ForceDimensionDevice other(unlimited); }), test::contains("peak torque of 0 N m"));
}

TEST_CASE("force dimension: errors contain the SDK's message", "[device][force_dimension]") {
  fake_dhd::Scope sdk;
  sdk.sdk.open_answer = -1;
  CHECK_THAT(dhd_refusal([] { ForceDimensionDevice device; }), test::contains("no device found"));
  sdk.sdk.open_answer = 0;
  ForceDimensionDevice device;
  sdk.sdk.enable_answer = -1;
  CHECK_THAT(dhd_refusal([&] { device.start(); }), test::contains("enable forces"));
  device.read();
  device.write(gated(Vector3(0.0, 1.0, 0.0)));
  CHECK(dhd_force() == Vector3::Zero());
}
