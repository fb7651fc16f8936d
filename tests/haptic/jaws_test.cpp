// Jaws: two tools on a joint, one force on the device, and what presses them apart.
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/haptic/jaws.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/testing/device_laws.hpp>
#include <palpate/testing/random.hpp>

#include "contact/servo_session.hpp"
#include "haptic/handle.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace palpate;

// Short names that other tests of this folder have, too.
namespace jaws_test {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using test::Handle;

/// An opening that the test sets.
struct GivenOpening {
  const double* value;
  double operator()(const ToolState&) const noexcept { return *value; }
};

Matrix3 rotation_of(const ToolState& s) {
  return rotation_matrix({s.orientation[0], s.orientation[1], s.orientation[2], s.orientation[3]});
}

}  // namespace

TEST_CASE("jaws rotate about their pivot by half of the opening, in opposite directions", "[haptic][jaws]") {
  testing::Random random(3);
  Handle handle;
  ToolState given;
  given.position = Vector3(0.1, -0.2, 0.05);
  const Matrix3 rotation = testing::random_rotation(random);
  const Quaternion<double> q = quaternion_of(rotation);
  given.orientation = {q.w, q.x, q.y, q.z};
  handle.path = [&](int) { return given; };
  double opening = 0.4;
  const JawJoint joint{.pivot = {0.01, 0.02, -0.03}, .axis = {0.0, 3.0, 4.0}};
  Jaws jaws(handle, joint, GivenOpening{&opening});
  const ToolState first = jaws.first().read(), second = jaws.second().read();
  CHECK(handle.tick == 1);  // read once
  const Vector3 axis(0.0, 0.6, 0.8);
  for (const ToolState& s : {first, second})
    CHECK((s.position - (given.position + rotation * joint.pivot)).norm() <= 1e-15);
  CHECK((rotation_of(first) - rotation * rotation_by(0.2 * axis)).norm() <= 1e-12);
  CHECK((rotation_of(second) - rotation * rotation_by(-0.2 * axis)).norm() <= 1e-12);
  CHECK(jaws.opening() == 0.4);
  opening = 5.0;
  jaws.first().read();
  CHECK(jaws.opening() == joint.widest);
  opening = not_a_number;  // the last one stays
  jaws.first().read();
  CHECK(jaws.opening() == joint.widest);
  opening = -0.01;
  jaws.first().read();
  CHECK(jaws.opening() == 0.0);
  CHECK(jaws.first().limits().stiffness == 2000.0);
  CHECK(jaws.first().limits().rotational_stiffness == 5.0);
  handle.device.rotational_stiffness = 1.0;
  CHECK(Jaws(handle, joint, GivenOpening{&opening}).first().limits().rotational_stiffness == 0.5);
}

TEST_CASE("the device has the sum of the forces on the jaws, within its limits", "[haptic][jaws]") {
  Handle handle;
  double opening = 0.3;
  const JawJoint joint{.pivot = {0.0, 0.0, -0.05}, .axis = {0.0, 2.0, 0.0}};
  Jaws jaws(handle, joint, GivenOpening{&opening});
  const Vector3 up(1.0, 0.2, 3.0), down(0.5, 0.0, -2.5), first(0.0, 0.3, 0.1), second(0.1, -0.2, 0.0);
  jaws.first().start();
  jaws.second().start();
  const auto tick = [&](double factor) {
    jaws.first().read();
    jaws.second().read();
    jaws.first().write(testing::gated(factor * up, first));
    jaws.second().write(testing::gated(factor * down, second));
  };
  for (int i = 0; i < 200; ++i) tick(1.0);
  CHECK(handle.writes == 200);
  CHECK((handle.force.force() - (up + down)).norm() <= 1e-12);
  const Vector3 torque = first + second + joint.pivot.cross(up + down);
  CHECK((handle.force.torque() - torque).norm() <= 1e-12);
  CHECK(jaws.joint_torque() == Catch::Approx(0.5 * (0.3 + 0.2)));
  for (int i = 0; i < 200; ++i) tick(1e3);
  CHECK(handle.force.force().norm() <= handle.device.peak_force * (1.0 + 1e-12));
  CHECK(handle.force.status.has(StatusFlag::saturated));
  jaws.first().read();
  jaws.first().write(testing::gated(1e3 * up));
  CHECK(jaws.second().write(testing::gated(1e3 * up)).has(StatusFlag::saturated));
  jaws.first().write(GatedForce{});  // the loop has ended: no state was read
  jaws.second().write(testing::gated(up));
  CHECK(handle.force.force().norm() == 0.0);
  jaws.first().stop();
  jaws.second().stop();
  CHECK(handle.starts == 1);
  CHECK(handle.stops == 1);
  handle.path = [](int) {
    ToolState s;
    s.valid = false;
    return s;
  };
  tick(1.0);
  CHECK(handle.force.force().norm() == 0.0);
}

TEST_CASE("a button closes jaws at constant speed", "[haptic][jaws]") {
  ButtonOpening opening(2u, 0.5, 1.0);
  ToolState s;
  const auto after = [&](int ticks, std::uint32_t buttons) {
    double value = 0.0;
    for (int i = 0; i < ticks; ++i) {
      s.time += 1e-3;
      s.buttons = buttons;
      value = opening(s);
    }
    return value;
  };
  CHECK(after(1, 0) == 0.5);
  CHECK(after(200, 2) == Catch::Approx(0.3));
  CHECK(after(100, 1) == Catch::Approx(0.4));  // another button
  CHECK(after(1000, 2) == 0.0);
  s.time = not_a_number;
  CHECK(after(1, 0) == 0.0);
}

TEST_CASE("jaws with an impossible joint are refused", "[haptic][jaws][refused]") {
  Handle handle;
  const auto refuses = [&](JawJoint joint) { CHECK_REFUSED(SetupErrorKind::bad_argument, Jaws(handle, joint)); };
  refuses({.pivot = {not_a_number, 0.0, 0.0}});
  refuses({.axis = {0.0, 0.0, 0.0}});
  refuses({.widest = 0.0});
  refuses({.widest = 3.5});
  refuses({.grip_force = 0.0});
  refuses({.grip_torque = -1.0});
  refuses({.stiffness = infinity});
  CHECK_REFUSED(SetupErrorKind::bad_argument, Jaws(handle, JawJoint{}, ButtonOpening(), 0.0));
  CHECK_REFUSED(SetupErrorKind::bad_argument, ButtonOpening(1u, -0.5));
  CHECK_REFUSED(SetupErrorKind::bad_argument, ButtonOpening(1u, 0.5, 0.0));
}

namespace {

/// A slab of 40 x 20 x 6 mm around z = 0, fixed at x = 0.
using Slab = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
Slab make_slab() {
  return {box_tet4({40e-3, 20e-3, 6e-3}, {20, 10, 3}, BoxSplit::five_mirrored, {0.0, -10e-3, -3e-3}),
          Scene().fix("x0").touch("surface"), LinearElastic{.youngs_modulus = 20e3, .poisson_ratio = 0.4}};
}

constexpr double reach = 25e-3;    // from the pivot to the middle of the plates
constexpr double closed_at = 0.2;  // [rad] the opening at which the plates are parallel
constexpr double plate_radius = 1e-3;

/// A plate, parallel to the other one at the opening `closed_at`, with its inner side `distance` from the middle then.
/// It is wider than the slab and reaches beyond its free end: no rim of a dent holds it.
ConvexTool plate(double side, double distance) {
  const Matrix3 back = rotation_by(Vector3(0.0, -0.5 * side * closed_at, 0.0));
  std::vector<Vector3> points;
  for (const double x : {-reach, 20e-3 - reach})
    for (const double y : {-13e-3, 13e-3}) points.push_back(back * Vector3(x, y, side * (distance + plate_radius)));
  return {points, plate_radius};
}

/// Closes the jaws on the slab, then pulls them away from its support.
struct Pinch {
  explicit Pinch(double friction)
      : jaws(handle, JawJoint{.widest = 0.6, .stiffness = 50.0}, GivenOpening{&opening}),
        servo(slab, {plate(1.0, 2e-3), plate(-1.0, 2e-3)}, options(friction)) {
    handle.path = [this](int) {
      ToolState s;
      s.position = Vector3(25e-3 + reach + pulled, 0.0, 0.0);
      return s;
    };
  }
  static ServoOptions options(double friction) {
    ServoOptions o{.coupling_stiffness = 5000.0};
    o.rotational_stiffness = 50.0;
    o.force_limits = test::open_gate();
    o.force_limits->peak_torque = 10.0;
    o.contact.friction = friction;
    return o;
  }
  void tick() {
    const std::array<ToolState, 2> states{jaws.first().read(), jaws.second().read()};
    const auto forces = servo.tick(states);
    jaws.first().write(forces[0]);
    jaws.second().write(forces[1]);
  }
  void close() {
    for (int i = 0; i <= 300; ++i) {
      opening = 0.6 + (closed_at - 0.6) * i / 300.0;
      tick();
    }
    for (int i = 0; i < 50; ++i) tick();
  }
  /// The mean of the normal forces on the jaws.
  double grip() const {
    double sum = 0.0;
    for (const ToolContact& c : servo.tick_view().contacts()) sum += c.force * std::abs(c.normal[2]);
    return 0.5 * sum;
  }

  Slab slab = make_slab();
  Handle handle;
  double opening = 0.6, pulled = 0.0;
  Jaws<Handle, GivenOpening> jaws;
  HapticServo servo;
};

}  // namespace

TEST_CASE("jaws hold a slab up to Coulomb's force, and slip above it", "[haptic][jaws][friction]") {
  const double friction = GENERATE(0.15, 0.3);
  Pinch pinch(friction);
  pinch.close();
  const double grip = pinch.grip(), lever = pinch.jaws.joint_torque() / grip;
  REQUIRE(grip > 0.1);
  CHECK(pinch.handle.force.force().norm() <= 0.1 * grip);  // they press against each other, not the hand
  CHECK(lever > reach - 15e-3);                            // the slab is from there
  CHECK(lever < reach);
  double most = 0.0, slips_at = 0.0;
  for (int i = 0; i < 1200; ++i) {
    pinch.pulled = 1e-5 * i;
    pinch.tick();
    const double pull = -pinch.handle.force.force()[0] / (2.0 * pinch.grip());
    if (slips_at == 0.0 && pull > 0.9 * friction) slips_at = pinch.pulled;
    most = std::max(most, pull);
  }
  CAPTURE(friction, grip, slips_at);
  CHECK(most == Catch::Approx(friction).epsilon(0.05));
  CHECK(slips_at > 2e-3);  // before, it stretches the slab
  CHECK(slips_at < 11e-3);
}

TEST_CASE("a session takes jaws as two devices", "[haptic][jaws][session]") {
  Slab slab = make_slab();
  Handle handle;
  handle.path = [](int tick) {
    ToolState s;
    s.position = Vector3(25e-3 + reach, 0.0, 0.0);
    s.buttons = tick > 20 ? 1u : 0u;
    return s;
  };
  Jaws jaws(handle, JawJoint{}, ButtonOpening(1u, 0.6, 5.0));
  HapticSession session(jaws.devices(), slab, {plate(1.0, 2e-3), plate(-1.0, 2e-3)},
                        ServoOptions{.contact = {.friction = 0.3}});
  session.run({.duration = 0.15, .paced = false});
  CHECK(session.snapshot().contact_force(0)[2] > 0.1);
  CHECK(session.snapshot().contact_force(1)[2] < -0.1);
  CHECK(jaws.opening() < 0.1);
  CHECK(handle.writes > 100);
  CHECK(handle.stops == 1);
}

}  // namespace jaws_test
