// Parameters that change while a servo ticks: they arrive, and the force does not jump.
#include <palpate/contact/tissue_group.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/haptic/haptic_session.hpp>

#include "contact/servo_session.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace palpate;
using test::Pad;
using test::pad_height;

// Short names that other tests of this folder have, too.
namespace live_parameters_test {

namespace {

using test::sphere_radius;

/// A sphere 1.5 mm deep that slides at 10 mm/s.
struct Sliding {
  explicit Sliding(HapticServo& s, double metres_per_second = 10e-3) : servo(s), speed(metres_per_second) {}

  /// Ticks, and returns the largest change of the force between two of them.
  double run(int ticks) {
    double jump = 0.0;
    for (int i = 0; i < ticks; ++i) {
      ToolState s;
      s.time = s.now = 1e-3 * number;
      s.position = Vector3(8e-3 + speed * 1e-3 * number, 0.015, pad_height + sphere_radius - 1.5e-3);
      ++number;
      servo.tick(s);
      const Vector3 now = servo.tick_view().contact_force();
      if (number > 1) jump = std::max(jump, (now - force).norm());
      force = now;
    }
    return jump;
  }
  double normal() const {
    double sum = 0.0;
    for (const ToolContact& c : servo.tick_view().contacts()) sum += c.force;
    return sum;
  }
  double friction() const {
    double sum = 0.0;
    for (const ToolContact& c : servo.tick_view().contacts()) sum += c.friction.norm();
    return sum;
  }

  HapticServo& servo;
  double speed;
  Vector3 force = Vector3::Zero();
  int number = 0;
};

ServoOptions options_with(double stiffness, double friction) {
  ServoOptions options{.coupling_stiffness = stiffness};
  options.force_limits = test::open_gate();
  options.contact.friction = friction;
  return options;
}

}  // namespace

TEST_CASE("friction of a tissue changes beside ticks, without a jump", "[haptic][servo][live]") {
  Pad pad = test::make_pad(), other = test::make_pad();
  other.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.0)));
  TissueGroup group(pad);
  group.add(other, 0.2);
  HapticServo servo(group, SphereTool{sphere_radius}, options_with(2000.0, 0.1));
  Sliding sliding(servo);
  const double usual = (sliding.run(400), sliding.run(100));
  CHECK(sliding.friction() == Catch::Approx(0.1 * sliding.normal()).epsilon(0.02));
  servo.set_friction(0.5);
  CHECK(servo.friction() == 0.5);
  CHECK(servo.friction(1) == 0.2);
  const double jump = sliding.run(100);
  const double change = 0.4 * sliding.normal();
  CHECK(jump <= usual + 0.05 * change);
  sliding.run(250);
  CHECK(sliding.friction() == Catch::Approx(0.5 * sliding.normal()).epsilon(0.02));
  servo.set_friction(0.0);
  CHECK(sliding.run(100) <= usual + 0.05 * change);
  sliding.run(10);
  CHECK(sliding.friction() <= 1e-6 * sliding.normal());
}

TEST_CASE("the coupling of a tool changes beside ticks, to the force of a servo that was made with it",
          "[haptic][servo][live]") {
  Pad pad = test::make_pad();
  HapticServo servo(pad, SphereTool{sphere_radius}, options_with(50.0, 0.0)),
      other(pad, SphereTool{sphere_radius}, options_with(2000.0, 0.0));
  Sliding sliding(servo, 0.0), expected(other, 0.0);
  sliding.run(100);
  expected.run(100);
  const double change = (expected.force - sliding.force).norm();
  REQUIRE(change > 0.1 * expected.force.norm());
  servo.set_coupling_stiffness(2000.0);
  CHECK(servo.coupling_stiffness() == Catch::Approx(2000.0));
  CHECK(sliding.run(100) <= 0.05 * change);
  sliding.run(20);
  CHECK((sliding.force - expected.force).norm() <= 2e-3 * expected.force.norm());
}

TEST_CASE("parameters that do not change have the bits of a servo without", "[haptic][servo][live]") {
  Pad pad = test::make_pad();
  HapticServo servo(pad, SphereTool{sphere_radius}, options_with(700.0, 0.3)),
      other(pad, SphereTool{sphere_radius}, options_with(700.0, 0.3));
  Sliding first(servo), second(other);
  int differing = 0;
  for (int i = 0; i < 300; ++i) {
    if (i == 100) servo.set_friction(0.3), servo.set_coupling_stiffness(700.0);
    first.run(1);
    second.run(1);
    differing += first.force != second.force;
  }
  CHECK(differing == 0);
}

TEST_CASE("a coupling that becomes far stiffer on stiff tissue does not jump either", "[haptic][servo][live]") {
  Pad pad = test::make_pad("z1", 1e6);
  HapticServo servo(pad, SphereTool{sphere_radius}, options_with(5.0, 0.0));
  Sliding sliding(servo, 0.0);
  sliding.run(100);
  const double before = sliding.force.norm();
  servo.set_coupling_stiffness(2000.0);
  const double jump = sliding.run(100);
  CHECK(sliding.force.norm() > 50.0 * before);
  CHECK(jump <= 0.1 * sliding.force.norm());
}

TEST_CASE("a reset settles parameters that are on their way", "[haptic][servo][live]") {
  Pad pad = test::make_pad();
  HapticServo servo(pad, SphereTool{sphere_radius}, options_with(2000.0, 0.1));
  servo.set_friction(0.5);
  servo.set_coupling_stiffness(200.0);
  servo.reset();
  Sliding first(servo);
  first.run(40);
  servo.reset();
  Sliding second(servo);
  second.run(40);
  CHECK(first.force == second.force);
  CHECK(servo.friction() == 0.5);
}

TEST_CASE("parameters of a session change while it runs, within what the device renders", "[haptic][session][live]") {
  Pad pad = test::make_pad();
  MockDevice device([](double) noexcept { return Vector3(0.015, 0.015, pad_height + sphere_radius - 1e-3); });
  HapticSession session(device, pad, SphereTool{sphere_radius}, ServoOptions{.contact = {.friction = 0.2}});
  session.start();
  for (int i = 0; i < 50; ++i) {
    session.set_friction(0.01 * i);
    session.set_coupling_stiffness(100.0 + i);
  }
  CHECK_REFUSED(SetupErrorKind::bad_argument, session.set_coupling_stiffness(1e7));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, session.set_coupling_stiffness(100.0, 1));
  session.stop();
  CHECK(session.servo().friction() == 0.49);
  CHECK(session.servo().coupling_stiffness() == Catch::Approx(149.0));
}

TEST_CASE("parameters that no servo can have are refused", "[haptic][servo][live][refused]") {
  Pad pad = test::make_pad();
  HapticServo rough(pad, SphereTool{sphere_radius}, options_with(1000.0, 0.3)), smooth(pad, SphereTool{sphere_radius});
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-0.1, nan, 4.5}) CHECK_REFUSED(SetupErrorKind::bad_argument, rough.set_friction(bad));
  for (const double bad : {0.0, -1.0, nan})
    CHECK_REFUSED(SetupErrorKind::bad_argument, rough.set_coupling_stiffness(bad));
  CHECK_NOTHROW(rough.set_coupling_stiffness(infinity));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, rough.set_friction(0.2, 1));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, rough.set_coupling_stiffness(100.0, 1));
  CHECK_REFUSED(SetupErrorKind::unsupported, smooth.set_friction(0.2));
  CHECK_NOTHROW(smooth.set_friction(0.0));
  CHECK(rough.friction() == 0.3);
}

}  // namespace live_parameters_test
