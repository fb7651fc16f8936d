// Tools through a port: what the tip does, what the handle feels, and that both have the same work.
#include <palpate/haptic/trocar.hpp>

#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/testing/device_laws.hpp>
#include <palpate/testing/random.hpp>

#include "contact/servo_session.hpp"
#include "haptic/handle.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace palpate;

// Short names that other tests of this folder have, too.
namespace trocar_test {

namespace {

using test::Handle;

Quaternion<double> orientation(const ToolState& s) {
  return {s.orientation[0], s.orientation[1], s.orientation[2], s.orientation[3]};
}

const TrocarPort port{.position = {0.02, -0.01, 0.05}, .shaft = {0.0, 3.0, 4.0}, .length = 0.3};

/// What a device renders in a steady state, so that ramps are over.
template <class Device>
GatedForce rendered(Device& device, Handle& handle, const GatedForce& force) {
  for (int i = 0; i < 200; ++i) {
    device.read();
    device.write(force);
  }
  return handle.force;
}

}  // namespace

TEST_CASE("the tip of a tool through a port is opposite to the handle", "[haptic][trocar]") {
  Handle handle;
  testing::Random random(5);
  for (int i = 0; i < 50; ++i) {
    FulcrumDevice tip(handle, port);
    const Vector3 away = random.vector<3>(-1.0, 1.0).normalized();
    const double outside = 0.1 + 0.15 * random.uniform();
    handle.state.position = port.position + outside * away;
    const ToolState s = tip.read();
    CHECK((s.position - (port.position - (port.length - outside) * away)).norm() <= 1e-12);
    const Vector3 axis = rotation_matrix(orientation(s)) * Vector3(0.0, 0.6, 0.8);
    CHECK((axis + away).norm() <= 1e-9);
    CHECK(tip.lever() == Catch::Approx((port.length - outside) / outside));
  }
  FulcrumDevice tip(handle, port);
  handle.state.position = port.position + Vector3(0.0, 0.0, 0.01);  // closer than the longest lever allows
  CHECK((tip.read().position - (port.position - Vector3(0.0, 0.0, 0.225))).norm() <= 1e-12);
  CHECK(tip.lever() == Catch::Approx(3.0));
  handle.state.position = port.position;
  CHECK(tip.read().position.allFinite());
}

TEST_CASE("force and torque at the tip do the work of the force at the handle", "[haptic][trocar]") {
  testing::Random random(6);
  for (int i = 0; i < 20; ++i) {
    Handle handle;
    FulcrumDevice tip(handle, port);
    const Vector3 at = port.position + (0.1 + 0.15 * random.uniform()) * random.vector<3>(-1.0, 1.0).normalized();
    const Vector3 force = random.vector<3>(-1.0, 1.0), torque = random.vector<3>(-0.1, 0.1);
    handle.state.position = at;
    const Vector3 at_handle = rendered(tip, handle, testing::gated(force, torque)).force();
    constexpr double step = 1e-6;
    for (int c = 0; c < 3; ++c) {
      const Vector3 path = step * Vector3::Unit(c);
      handle.state.position = at - path;
      const ToolState before = tip.read();
      handle.state.position = at + path;
      const ToolState after = tip.read();
      const Matrix3 turn = rotation_matrix(orientation(after)) * rotation_matrix(orientation(before)).transpose();
      // Roll about the shaft has no effect: the mapping leaves it out.
      const Vector3 axis = (port.position - at).normalized();
      Vector3 angle = rotation_vector(turn);
      angle -= angle.dot(axis) * axis;
      const double work = force.dot(after.position - before.position) + torque.dot(angle);
      CHECK(at_handle.dot(2.0 * path) == Catch::Approx(work).epsilon(1e-5).margin(1e-10));
    }
  }
}

TEST_CASE("a session with a fulcrum renders no more stiffness than the device can", "[haptic][trocar]") {
  Handle handle;
  FulcrumDevice tip(handle, port);
  const DeviceLimits limits = tip.limits();
  CHECK(limits.stiffness == Catch::Approx(0.8 * 4000.0 / 9.0));
  // A spring at the tip, as it acts at the handle across the shaft, also where that is nearer than the longest lever.
  const double least = 0.075;
  for (const double distance : {2.0 * least, least, 0.5 * least, 0.1 * least, 0.02 * least}) {
    handle.state.position = port.position + Vector3(0.0, 0.0, distance);
    const Vector3 at = tip.read().position;
    handle.state.position += Vector3(1e-3 * distance, 0.0, 0.0);
    const Vector3 moved = tip.read().position - at;
    const GatedForce at_handle = rendered(tip, handle, testing::gated(-limits.stiffness * moved));
    const double stiffness = -at_handle.force()[0] / (1e-3 * distance);
    CAPTURE(distance, stiffness);
    CHECK(stiffness <= 0.81 * handle.device.stiffness);
    CHECK(stiffness > 0.08 * handle.device.stiffness);
    CHECK(at_handle.status.has(StatusFlag::degraded_model) == (distance < least));
  }
}

TEST_CASE("a handle beyond the port stays at it", "[haptic][trocar]") {
  Handle handle;
  FulcrumDevice tip(handle, port);
  handle.state.position = port.position + Vector3(0.0, 0.0, 0.1);
  tip.read();
  for (const double beyond : {-1e-4, -0.05}) {
    handle.state.position = port.position + Vector3(0.0, 0.0, beyond);
    CHECK((tip.read().position - (port.position - Vector3(0.0, 0.0, 0.225))).norm() <= 1e-9);
    CHECK(rendered(tip, handle, testing::gated(Vector3(1.0, 0.0, 0.0))).force().norm() == 0.0);
  }
  handle.state.position = port.position + Vector3(0.0, 0.0, 0.1);
  CHECK((tip.read().position - (port.position - Vector3(0.0, 0.0, 0.2))).norm() <= 1e-9);
}

TEST_CASE("a port draws the shaft back, at the handle as force and torque", "[haptic][trocar]") {
  Handle handle;
  const TrocarPort down{.position = {0.0, 0.0, 0.0}, .length = 0.3, .stiffness = 1000.0};
  PortedDevice device(handle, down);
  handle.state.position = Vector3(2e-3, 0.0, 0.1);  // 2 mm beside the port, 100 mm above
  GatedForce at_handle = rendered(device, handle, testing::gated(Vector3(0.0, 0.0, 0.5)));
  CHECK(device.deviation() == Catch::Approx(2e-3));
  CHECK((at_handle.force() - Vector3(-2.0, 0.0, 0.5)).norm() <= 1e-9);
  CHECK((at_handle.torque() - Vector3(0.0, 0.2, 0.0)).norm() <= 1e-9);  // (0, 0, -0.1) x (-2, 0, 0)
  handle.state.position = Vector3(30e-3, 0.0, 0.1);                     // beyond the radius, but it has entered before
  CHECK(rendered(device, handle, testing::gated(Vector3(0.0, 0.0, 0.0))).force()[0] == Catch::Approx(-30.0));
  CHECK(device.is_in_port());
  handle.state.position = Vector3(0.0, 0.0, 0.1);
  at_handle = rendered(device, handle, testing::gated(Vector3(0.1, 0.0, 0.0)));
  CHECK((at_handle.force() - Vector3(0.1, 0.0, 0.0)).norm() <= 1e-9);
  for (const double height : {-0.05, 0.35, 0.1}) {  // the port is not beside the shaft; then it is, but far away
    handle.state.position = Vector3(0.05, 0.0, height);
    CHECK(rendered(device, handle, testing::gated(Vector3(0.1, 0.0, 0.0))).force()[0] == Catch::Approx(0.1));
    CHECK_FALSE(device.is_in_port());
  }
  CHECK(device.limits().stiffness == Catch::Approx(3000.0));
}

TEST_CASE("the force of a port begins with a ramp when the shaft enters", "[haptic][trocar]") {
  Handle handle;
  PortedDevice device(handle, TrocarPort{.position = {0.0, 0.0, 0.0}, .length = 0.3, .stiffness = 1000.0});
  double jump = 0.0, before = 0.0;
  for (int i = 0; i < 400; ++i) {
    handle.state.position = Vector3(8e-3, 0.0, -0.01 + 1e-4 * i);  // from beside the port, 8 mm from its middle
    device.read();
    device.write(testing::gated(Vector3(0.0, 0.0, 0.0)));
    jump = std::max(jump, std::abs(handle.force.force()[0] - before));
    before = handle.force.force()[0];
  }
  CHECK(before == Catch::Approx(-8.0));
  CHECK(jump <= 0.5);
}

TEST_CASE("a device around another one keeps its log, its flags and its silence", "[haptic][trocar]") {
  struct Logging : Handle {
    void note(Status status, double now) noexcept { noted = status, at = now; }
    bool restarts() const noexcept { return false; }
    Status noted;
    double at = 0.0;
  };
  Logging handle;
  PortedDevice device(handle, TrocarPort{.position = {0.0, 0.0, 0.0}, .length = 0.3, .stiffness = 1000.0});
  device.note(StatusFlag::ramping, 3.5);
  CHECK(handle.noted.has(StatusFlag::ramping));
  CHECK(handle.at == 3.5);
  CHECK_FALSE(device.restarts());
  handle.state.position = Vector3(5e-3, 0.0, 0.1);
  CHECK(rendered(device, handle, testing::gated(Vector3(1.0, 0.0, 0.0))).force().norm() > 1.0);
  device.read();
  CHECK(device.write(testing::gated(Vector3(0.0, 0.0, 1e3))).has(StatusFlag::saturated));
  device.write(GatedForce{});  // the loop has ended: no state was read
  CHECK(handle.force.force().norm() == 0.0);
  FulcrumDevice tip(handle, port);
  handle.state.position = port.position + Vector3(0.0, 0.1, 0.1);
  CHECK(rendered(tip, handle, testing::gated(Vector3(1.0, 0.0, 0.0))).force().norm() > 0.1);
  tip.write(testing::gated(Vector3(1.0, 0.0, 0.0)));
  CHECK(handle.force.force().norm() == 0.0);
}

TEST_CASE("readings that are no pose move nothing, and give no force", "[haptic][trocar]") {
  Handle handle;
  FulcrumDevice tip(handle, port);
  handle.state.position = port.position + Vector3(0.0, 0.1, 0.1);
  CHECK(rendered(tip, handle, testing::gated(Vector3(1.0, 0.0, 0.0))).force().norm() > 0.1);
  handle.state.position[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(tip.read().position[1]));
  handle.state.position[1] = 0.1;
  handle.state.valid = false;
  CHECK_FALSE(tip.read().valid);
  tip.write(testing::gated(Vector3(1.0, 0.0, 0.0)));
  CHECK(handle.force.force().norm() == 0.0);
}

TEST_CASE("a session feels tissue through a port", "[haptic][trocar][session]") {
  test::Pad pad = test::make_pad();
  Handle handle;
  const TrocarPort above{.position = {0.015, 0.015, test::pad_height + 0.1}, .length = 0.25};
  // The tip 1 mm deep, straight below the port: 0.25 - (0.1 - 4 mm + 1 mm) outside.
  handle.state.position = above.position + Vector3(0.0, 0.0, 0.25 - 0.1 + test::sphere_radius - 1e-3);
  FulcrumDevice tip(handle, above);
  HapticSession session(tip, pad, SphereTool{test::sphere_radius});
  session.run({.duration = 0.2, .paced = false});
  const Vector3 force = session.snapshot().contact_force();
  CHECK(force[2] > 0.01);
  CHECK(handle.starts == 1);
  CHECK(handle.stops == 1);
}

TEST_CASE("ports that cannot be are refused", "[haptic][trocar][refused]") {
  Handle handle;
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [&](const TrocarPort& bad) {
    CHECK_REFUSED(SetupErrorKind::bad_argument, FulcrumDevice(handle, bad));
    CHECK_REFUSED(SetupErrorKind::bad_argument, PortedDevice(handle, bad));
  };
  refuses({.position = {not_a_number, 0.0, 0.0}});
  refuses({.shaft = {0.0, 0.0, 0.0}});
  refuses({.length = 0.0});
  refuses({.longest_lever = -1.0});
  refuses({.stiffness = infinity});
  refuses({.radius = 0.0});
  CHECK_REFUSED(SetupErrorKind::bad_argument, FulcrumDevice(handle, port, 0.0));
  CHECK_REFUSED(SetupErrorKind::bad_argument, PortedDevice(handle, TrocarPort{.stiffness = 1e5}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, PortedDevice(handle, TrocarPort{.length = 0.3, .stiffness = 3e3}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, PortedDevice(handle, TrocarPort{.length = 0.1, .stiffness = 3e3}, 500.0));
}

}  // namespace trocar_test
