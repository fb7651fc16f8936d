// A device placed in a scene.
#include <palpate/device/mock_device.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/testing/device_laws.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

Placement some_placement() {
  Placement p;
  p.device_origin = {0.01, -0.02, 0.03};
  p.scene_origin = {1.0, 2.0, 3.0};
  p.rotation = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  p.scale = 0.25;
  p.force_scale = 3.0;
  return p;
}

struct StillDevice {
  ToolState state;
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
  DeviceLimits given;
  ToolState read() noexcept { return state; }
  Status write(const GatedForce& f) noexcept {
    force = f.force();
    torque = f.torque();
    return {};
  }
  DeviceLimits limits() const noexcept { return given; }
  void start() {}
  void stop() noexcept {}
};

}  // namespace

TEST_CASE("a placement and its inverse", "[device][placement]") {
  const Placement p = some_placement();
  testing::Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3 x = random.vector<3>(-0.2, 0.2);
    CHECK((p.to_device(p.to_scene(x)) - x).norm() <= 1e-14);
  }
  CHECK((p.to_scene(p.device_origin) - p.scene_origin).norm() == 0.0);
  const Vector3 step(0.01, 0.0, 0.0);
  CHECK_THAT((p.to_scene(p.device_origin + step) - p.scene_origin).norm(), WithinRel(0.25 * 0.01, 1e-12));
}

TEST_CASE("a spring in the scene is rendered with scale times force_scale times its stiffness", "[device][placement]") {
  const Placement p = some_placement();
  const double k = 700.0;
  const Vector3 rest(1.1, 2.2, 3.3), hand(0.02, 0.01, 0.04), step(1e-3, -2e-3, 5e-4);
  const auto rendered = [&](const Vector3& x) { return p.force_to_device(k * (rest - p.to_scene(x))); };
  CHECK((rendered(hand + step) - rendered(hand) + p.handle_stiffness(k) * step).norm() <= 1e-12 * k);
  // Work: force is scaled by f, displacement by 1 / s.
  const Vector3 force(1, 2, 3), path = p.to_scene(hand + step) - p.to_scene(hand);
  CHECK_THAT(p.force_to_device(force).dot(step), WithinRel(p.force_scale / p.scale * force.dot(path), 1e-12));
}

TEST_CASE("velocity, orientation and torque are transformed", "[device][placement]") {
  const Placement p = some_placement();
  StillDevice device;
  device.state.position = {0.1, 0.0, 0.0};
  device.state.velocity = {1.0, 2.0, 3.0};
  device.state.orientation = {std::cos(0.2), std::sin(0.2), 0.0, 0.0};
  device.state.time = 7.0;
  device.state.buttons = 5;
  PlacedDevice placed(device, p);
  const ToolState state = placed.read();
  CHECK((state.position - p.to_scene(device.state.position)).norm() == 0.0);
  CHECK((state.velocity - 0.25 * (p.rotation * device.state.velocity)).norm() <= 1e-15);
  const auto& q = state.orientation;
  const Matrix3 rotated = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  CHECK((rotated - p.rotation * Eigen::AngleAxisd(0.4, Vector3::UnitX()).toRotationMatrix()).norm() <= 1e-12);
  CHECK(state.time == 7.0);
  CHECK(state.buttons == 5);
  placed.write(testing::gated(Vector3(1, 2, 3), Vector3(4, 5, 6)));
  CHECK((device.force - 3.0 * (p.rotation.transpose() * Vector3(1, 2, 3))).norm() <= 1e-14);
  CHECK((device.torque - 12.0 * (p.rotation.transpose() * Vector3(4, 5, 6))).norm() <= 1e-14);
}

TEST_CASE("device limits in units of the scene", "[device][placement]") {
  const Placement p = some_placement();
  StillDevice device;
  const DeviceLimits scene = PlacedDevice(device, p).limits();
  CHECK_THAT(p.force_to_device(scene.peak_force * Vector3::UnitX()).norm(), WithinRel(device.given.peak_force, 1e-12));
  CHECK_THAT(p.handle_stiffness(scene.stiffness), WithinRel(device.given.stiffness, 1e-12));
  testing::Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Vector3 x = random.vector<3>(-0.1, 0.1);
    CHECK((p.to_scene(x).array() >= scene.workspace_low.array() - 1e-12).all());
    CHECK((p.to_scene(x).array() <= scene.workspace_high.array() + 1e-12).all());
  }
}

TEST_CASE("a warning for a stiffness too large for the device states what to change", "[device][placement]") {
  Placement p = some_placement();
  const DeviceLimits device;
  CHECK(!p.warning(device, device.stiffness / (p.scale * p.force_scale)));
  const double stiffness = 4.0 * device.stiffness / (p.scale * p.force_scale);
  const auto warning = p.warning(device, stiffness);
  REQUIRE(warning);
  CHECK(warning->find("0.25 times as large") != std::string::npos);
  p.scale *= 0.25;  // as the warning states
  CHECK(!p.warning(device, stiffness * (1 - 1e-12)));
  CHECK(p.warning(device, std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("invalid placements are refused", "[device][placement][extreme]") {
  StillDevice device;
  const auto refused = [&](auto change) {
    Placement p = some_placement();
    change(p);
    CHECK_THROWS_AS(PlacedDevice(device, p), SetupError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    refused([&](Placement& p) { p.scale = bad; });
    refused([&](Placement& p) { p.force_scale = bad; });
  }
  refused([&](Placement& p) { p.device_origin[1] = nan; });
  refused([&](Placement& p) { p.scene_origin[2] = infinity; });
  refused([](Placement& p) { p.rotation *= 1.001; });
  refused([](Placement& p) { p.rotation.col(0) *= -1.0; });
  refused([&](Placement& p) { p.rotation(0, 0) = nan; });
}

TEST_CASE("energy limits of a placed device are those of the device, in the scene's units", "[device][placement]") {
  Placement p = some_placement();
  p.scale = 10.0;
  p.force_scale = 2.0;
  const StillDevice device;
  const EnergyLimits own = EnergyLimits::from(device.limits()),
                     placed = EnergyLimits::from(p.limits_in_scene(device.limits()));
  CHECK_THAT(placed.allowance, WithinRel(5.0 * own.allowance, 1e-12));
  CHECK_THAT(placed.refill, WithinRel(5.0 * own.refill, 1e-12));
  CHECK_THAT(placed.capacity, WithinRel(5.0 * own.capacity, 1e-12));
  CHECK_THAT(placed.damping, WithinRel(own.damping / 20.0, 1e-12));
}

TEST_CASE("a placed device is a HapticDevice", "[device][placement]") {
  STATIC_REQUIRE(HapticDevice<PlacedDevice<StillDevice>>);
  MockDevice stylus(trajectory::poke({.from = {0, 0, 0.1}, .to = {0, 0, 0}}));
  STATIC_REQUIRE(HapticDevice<PlacedDevice<decltype(stylus)>>);
}

TEST_CASE("a force too large for a double in the device's scale is not rendered", "[device][placement][extreme][D7]") {
  MockDevice stylus(trajectory::poke());
  stylus.start();
  static_cast<void>(stylus.read());
  Placement p;
  p.force_scale = 1e308;
  PlacedDevice placed(stylus, p);
  const Vector3 hundred(100.0, 0.0, 0.0);
  CHECK(placed.write(testing::gated(hundred)) == Status(StatusFlag::non_finite_force));
  CHECK(stylus.last_force() == Vector3::Zero());
  CHECK(placed.write(testing::gated(Vector3(0.0, 0.0, 0.0), hundred)) == Status(StatusFlag::non_finite_force));
}
