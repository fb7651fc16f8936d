// A body with a touchable patch: inside and outside are those of the whole body.
#include "contact/servo_session.hpp"

#include <palpate/contact/tissue_group.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <palpate/mesh/where.hpp>

#include <algorithm>
#include <cmath>

using namespace palpate;
using test::pad_height;
using test::ServoSession;
using test::sphere_radius;

namespace {

/// The largest force of a session that stays at `height` and moves about over, beside and below the block.
double force_at(double height, std::uint64_t seed) {
  test::Pad pad = test::make_pad("z1");
  ServoSession session(pad);
  testing::Random random(seed);
  double largest = 0.0;
  session.tick(Vector3(0.015, 0.015, height));
  for (int k = 0; k < 20; ++k) {
    const Vector3 to(random.uniform(-0.02, 0.05), random.uniform(-0.02, 0.05), height);
    const Vector3 from = session.states[0].position;
    for (int i = 1; i <= 50; ++i) {
      const GatedForce& f = session.tick(from + (to - from) * i / 50);
      largest = std::max({largest, f.force().norm(), session.servo.tick_view().contact_force().norm()});
      CHECK_FALSE(f.status.has(StatusFlag::reacquired));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("below an open patch nothing presses, however far below", "[haptic][servo][extreme][D13]") {
  for (const double below : {0.005, 0.006, 0.02, 0.3, 10.0}) CHECK(force_at(-below, 3) == 0.0);
}

TEST_CASE("a tool that enters where the body cannot be touched passes through", "[haptic][servo][extreme][D13]") {
  test::Pad pad = test::make_pad("z1");
  const double speed = GENERATE(0.02, 0.2, 1.0);  // [m/s]
  for (const double height : {0.006, 0.012, 0.0145}) {
    ServoSession session(pad);
    const Vector3 left(-0.02, 0.0141, height), right(0.05, 0.0153, height);
    session.tick(left);
    const int ticks = static_cast<int>(0.07 / speed * 1e3);
    double largest = 0.0;
    for (int i = 1; i <= ticks; ++i) {
      session.tick(left + (right - left) * i / ticks);
      largest = std::max(largest, session.servo.tick_view().contact_force().norm());
    }
    CAPTURE(height, speed);
    CHECK(largest == 0.0);
    session.move(Vector3(0.05, 0.015, 0.06), 200);
    session.move(Vector3(0.0137, 0.0159, 0.06), 200);
    session.move(Vector3(0.0137, 0.0159, pad_height + sphere_radius - 1e-3), 200);
    CHECK(session.hold(50).force()[2] > 0.01);  // from above it is stopped, as before
  }
}

TEST_CASE("the sign of the distance to a patch is that of the body", "[contact][surface]") {
  test::Pad pad = test::make_pad("z1");
  const ContactSurface& top = pad.contact_surface();
  const auto in_model = [&](double x, double y, double z) { return pad.to_world().inverse() * Vector3(x, y, z); };
  REQUIRE(top.has_shell());
  CHECK(top.closest_of_body(in_model(0.015, 0.015, 0.019)).distance < 0.0);
  CHECK(top.closest_of_body(in_model(0.015, 0.015, 0.021)).distance > 0.0);
  CHECK(top.closest_of_body(in_model(-0.001, 0.015, 0.021)).distance > 0.0);  // beside the rim, above
  for (const auto& p : {in_model(0.015, 0.015, 0.001), in_model(0.001, 0.015, 0.015), in_model(0.015, 0.015, -0.001)})
    CHECK(top.closest_of_body(p).triangle < 0);
  CHECK(top.is_inside(in_model(0.001, 0.015, 0.015)));
  CHECK_FALSE(top.is_inside(in_model(-0.001, 0.015, 0.015)));
  CHECK_FALSE(top.is_inside(in_model(0.015, 0.015, -0.001)));
  const ContactSurface& whole = test::whole_pad().contact_surface();
  CHECK(whole.is_inside(whole.positions()[0] * 0.9));
}

TEST_CASE("a group has the inside of its members, also after one has moved", "[contact][group]") {
  test::Pad left = test::make_pad("z1"), right = test::make_pad("z1");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3(0.04, 0.0, 0.01);
  right.set_pose(pose);
  TissueGroup both(left, right);
  HapticServo servo(both, SphereTool{.radius = sphere_radius});
  const auto largest_force = [&](const Vector3& from, const Vector3& to) {
    ToolState state;
    double largest = 0.0;
    servo.reset();
    for (int i = 0; i <= 300; ++i) {
      state.time = 1e-3 * i;
      state.position = from + (to - from) * i / 300;
      servo.tick(state);
      largest = std::max(largest, servo.tick_view().contact_force().norm());
    }
    return largest;
  };
  const Vector3 across(0.09, 0.0, 0.0);
  CHECK(largest_force(Vector3(-0.01, 0.015, -0.006), Vector3(-0.01, 0.015, -0.006) + across) == 0.0);  // below both
  CHECK(largest_force(Vector3(0.055, 0.015, 0.0), Vector3(0.055, 0.015, 0.004)) == 0.0);  // below the higher one
  CHECK(largest_force(Vector3(0.055, 0.015, 0.036), Vector3(0.055, 0.015, 0.032)) > 0.01);
  pose.translation() = Vector3(0.04, 0.0, -0.01);
  right.set_pose(pose);
  CHECK(largest_force(Vector3(0.055, 0.015, 0.036), Vector3(0.055, 0.015, 0.026)) == 0.0);  // now above it
  CHECK(largest_force(Vector3(0.055, 0.015, -0.04), Vector3(0.055, 0.015, -0.016)) == 0.0);
  CHECK(largest_force(Vector3(0.055, 0.015, 0.016), Vector3(0.055, 0.015, 0.012)) > 0.01);
}

TEST_CASE("where a tool over the rim of a patch lacks force, every tick is flagged", "[haptic][servo][patch]") {
  // Cells of 1.5 mm; of the tops, all or a square of 18 mm can be touched.
  const auto make = [](bool all) {
    Scene scene;
    scene.fix("z0");
    if (all)
      scene.touch("z1");
    else
      scene.touch(where::box(Vector3(5.9e-3, 5.9e-3, pad_height - 1e-6), Vector3(24.1e-3, 24.1e-3, pad_height + 1e-6)));
    return test::Pad(box_tet4(Vector3(0.03, 0.03, pad_height), {20, 20, 8}, BoxSplit::six), scene,
                     LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.3});
  };
  test::Pad whole = make(true), patch = make(false);
  const double radius = 4.5e-3;
  const bool is_capsule = GENERATE(false, true);
  for (const double depth : {0.3e-3, 1e-3})
    for (double x = 1.0e-3; x <= 15e-3; x += 0.7e-3) {
      const auto press = [&](test::Pad& pad) {
        const ToolList tool = is_capsule ? ToolList(CapsuleTool(radius, 3e-3)) : ToolList(SphereTool{.radius = radius});
        HapticServo servo(pad, tool, ServoOptions{.coupling_stiffness = infinity});
        ToolState state;
        state.orientation = {std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0};  // along the y-axis
        Status status;
        for (int i = 0; i <= 100; ++i) {
          state.time += 1e-3;
          state.position = Vector3(x, 0.0151, pad_height + radius + 1e-4 - (1e-4 + depth) * i / 100.0);
          status = servo.tick(state).status;
        }
        return std::pair{servo.tick_view().contact_force()[2], status};
      };
      const auto [truth, clean] = press(whole);
      const auto [force, status] = press(patch);
      CAPTURE(is_capsule, depth, x, truth, force);
      CHECK_FALSE(clean.has(StatusFlag::lost_contact));  // an edge of the body is no rim
      if (force < 0.8 * truth) CHECK(status.has(StatusFlag::lost_contact));
      if (x > 11.5e-3) CHECK_FALSE(status.has(StatusFlag::lost_contact));
    }
}
