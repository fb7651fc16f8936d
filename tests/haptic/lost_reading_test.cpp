// Lost readings of a tool's pose: the tool does not pass through thin tissue, and no grasp begins by itself.
#include "contact/servo_session.hpp"

#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/detail/tool_input.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "catch.hpp"

using namespace palpate;

namespace {

/// A plate of 4 mm, fixed at two sides, touchable above and below.
test::Pad thin_plate() {
  Scene scene;
  scene.fix("x0").fix("x1").touch("z0").touch("z1");
  return test::Pad(box_tet4(Vector3(0.06, 0.06, 0.004), {12, 12, 2}, BoxSplit::six), scene,
                   LinearElastic{.youngs_modulus = 5e4, .poisson_ratio = 0.3});
}

struct Session {
  HapticServo servo;
  ToolState state;
  GatedForce force;

  explicit Session(test::Pad& pad, const ServoOptions& options = {}, double radius = test::sphere_radius)
      : servo(pad, SphereTool{.radius = radius}, options) {}
  const GatedForce& tick(const Vector3& position, bool valid = true) {
    state.time += 1e-3;
    state.position = position;
    state.valid = valid;
    return force = servo.tick(state);
  }
  void move(const Vector3& from, const Vector3& to, int ticks) {
    for (int i = 1; i <= ticks; ++i) tick(from + (to - from) * i / ticks);
  }
};

}  // namespace

TEST_CASE("a lost reading does not move the tool through thin tissue", "[haptic][servo][extreme][D12]") {
  test::Pad plate = thin_plate();
  const int lost = GENERATE(1, 5, 200);
  Session s(plate);
  const Vector3 above(0.0301, 0.0293, 0.012), pressed(0.0301, 0.0293, 0.0);
  s.tick(above);
  s.move(above, pressed, 200);
  for (int i = 0; i < 300; ++i) s.tick(pressed);
  const double before = s.force.force()[2];
  REQUIRE(before > 0.05);
  for (int i = 0; i < lost; ++i) CHECK(s.tick(pressed, false).force().norm() == 0.0);
  CHECK(s.tick(pressed).status.has(StatusFlag::reacquired));
  for (int i = 0; i < 500; ++i) CHECK(s.tick(pressed).force()[2] >= 0.0);
  CHECK(std::abs(s.force.force()[2] - before) <= 1e-3 * before);
}

TEST_CASE("after lost readings the tool is swept from its last proxy", "[haptic][servo][extreme][D12]") {
  test::Pad plate = thin_plate();
  Session s(plate);
  const Vector3 above(0.0301, 0.0293, 0.012), below(0.0301, 0.0293, -0.008);
  s.tick(above);
  s.move(above, Vector3(0.0301, 0.0293, 0.006), 100);
  s.tick(above, false);
  for (int i = 0; i < 400; ++i) s.tick(below);
  CHECK(s.force.force()[2] > 0.1);  // it is above the plate, which it dents
}

TEST_CASE("a grasp begins with a press of the button, not with a reading that returns",
          "[haptic][servo][grasp][extreme][D15]") {
  test::Pad pad = test::make_pad("z1");
  ServoOptions options;
  options.grasp_buttons = 1;
  Session s(pad, options);
  const double touching = test::pad_height + test::sphere_radius - 2e-4;
  const Vector3 above(0.0137, 0.0159, test::pad_height + 0.01), on(0.0137, 0.0159, touching);
  s.tick(above);
  s.move(above, on, 100);
  s.state.buttons = 1;
  s.tick(on);
  REQUIRE(s.servo.tick_view().is_holding());
  s.tick(on, false);
  s.tick(on);
  for (int i = 0; i < 50; ++i) s.tick(on);
  CHECK_FALSE(s.servo.tick_view().is_holding());
  s.move(on, above, 100);
  CHECK(s.force.force().norm() == 0.0);
  s.move(above, on, 100);
  s.state.buttons = 0;
  s.tick(on);
  s.state.buttons = 1;
  s.tick(on);
  CHECK(s.servo.tick_view().is_holding());
}

TEST_CASE("an invalid reading after the surface was lost lifts the tool", "[haptic][servo]") {
  test::Pad pad = test::make_pad("z1");
  const ContactSurface& surface = pad.contact_surface();
  detail::ToolInput input(0, false, 0);
  ContactTool tool;
  tool.radius = test::sphere_radius;
  ToolState state;
  state.position = Vector3(0.0137, 0.0159, test::pad_height);
  input.receive(state, pad.to_world(), surface, {}, tool);
  REQUIRE(tool.active);
  tool.force = Vector3(0.0, 0.0, 1.0);
  input.lose();
  state.valid = false;
  input.receive(state, pad.to_world(), surface, {}, tool);
  CHECK_FALSE(tool.active);
  CHECK(tool.force.norm() == 0.0);
  state.valid = true;
  input.receive(state, pad.to_world(), surface, {}, tool);
  CHECK(tool.active);
  CHECK(input.restarted());
}

TEST_CASE("where the tissue keeps a part of the force of a lost tool for a tick, that tick has not converged",
          "[haptic][servo]") {
  const double height = 18e-3;
  Scene scene;
  scene.fix("z0").touch("z1").expand(everywhere, 0.05);
  test::Pad pad(box_tet4(Vector3(36e-3, 36e-3, height), {6, 6, 3}, BoxSplit::five_mirrored), scene,
                LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4});
  const Vector3 along(1.0, 0.0, 0.0);
  const std::array<double, 3> radius{0.9e-3, 0.5e-3, 2e-3}, y{9.36e-3, 32.4e-3, 18e-3}, depth{0.25, 0.2, 0.2};
  HapticServo servo(pad,
                    ToolList{SphereTool{.radius = radius[0]}, CapsuleTool(radius[1], 1e-3, along),
                             CapsuleTool(radius[2], 4e-3, along)},
                    {.coupling_stiffness = 1000.0, .contact = {.subfacet_compliance = false}});
  std::array<ToolState, 3> states;
  for (int k = 0; k < 180; ++k) {
    const double in = 0.5 - 0.5 * std::cos(std::min(1.0, k / 135.0) * std::numbers::pi);
    for (std::size_t t = 0; t < 3; ++t) {
      states[t].time = states[t].now = 1e-3 * k;
      states[t].position = Vector3(18e-3, y[t], height + radius[t] * (1.5 - (0.5 + depth[t]) * in));
    }
    states[2].valid = k < 172;
    const Status status = servo.tick(states)[0].status;
    const double force = servo.tick_view().contact_force(0).norm();
    Vector3 sum =
        servo.tick_view().contact_force(0) + servo.tick_view().contact_force(1) + servo.tick_view().contact_force(2);
    const ServoSnapshot& snapshot = servo.read_snapshot();
    for (const VertexForce& f : snapshot.vertex_forces()) sum += f.force.in_model_axes();
    if (sum.norm() <= 0.01 * force) continue;
    CAPTURE(k, sum.norm(), force);
    CHECK(status.has(StatusFlag::solver_not_converged));
  }
}

TEST_CASE("a tool that cannot be read leaves no force on the tissue", "[haptic][servo][extreme][D12]") {
  // Pressed so deep that the steps of the contact solution have become shorter.
  using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  Model pad(box_tet4(Vector3(0.014, 0.014, 0.014), {2, 2, 2}), Scene().fix("z0").touch("z1"),
            LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4});
  HapticServo servo(pad, SphereTool{.radius = 4e-3}, {.coupling_stiffness = 1000.0});
  ToolState state;
  for (int k = 0; k < 90; ++k) {
    state.time = state.now = 1e-3 * k;
    const double in = 0.5 - 0.5 * std::cos(std::min(1.0, k / 67.0) * std::numbers::pi);
    state.position = Vector3(0.007, 0.007, 0.020 - 6e-3 * in);
    state.valid = k < 86;
    servo.tick(state);
    if (k == 85) REQUIRE(servo.tick_view().contact_force().norm() > 0.05);
  }
  const ServoSnapshot& snapshot = servo.read_snapshot();
  for (const VertexForce& f : snapshot.vertex_forces()) CHECK(f.force.in_model_axes().norm() == 0.0);
}
