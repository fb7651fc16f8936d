// Several tools of one servo, grasped points, and the data of a snapshot for both.
#include <palpate/haptic/haptic_servo.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <cmath>

using namespace palpate;

namespace {

constexpr double round_radius = 5e-3;

/// A servo on springs and its tools' states, one tick after the other.
struct Tools {
  test::AnalyticTissue tissue;
  HapticServo servo;
  std::vector<ToolState> states;
  std::vector<int> reacquired;

  explicit Tools(std::size_t count, const ServoOptions& options = {})
      : tissue(10, 0.04, 1e-3),
        servo(tissue, std::vector<SphereTool>(count, SphereTool{.radius = round_radius}), options),
        states(count),
        reacquired(count) {}
  void tick() {
    for (ToolState& s : states) s.time += 1e-3;
    const auto forces = servo.tick(states);
    for (std::size_t i = 0; i < forces.size(); ++i)
      if (forces[i].status.has(StatusFlag::reacquired)) ++reacquired[i];
  }
  void move(std::size_t i, const Vector3& to, int ticks) {
    const Vector3 from = states[i].position;
    for (int k = 1; k <= ticks; ++k) {
      states[i].position = from + (to - from) * k / ticks;
      tick();
    }
  }
};

}  // namespace

TEST_CASE("a tool of any number that lost the surface is placed again, while the other is in the air",
          "[haptic][servo][extreme]") {
  for (const std::size_t lost : {0u, 1u}) {
    Tools tools(2);
    tools.states[0].position = Vector3(0.05, 0.0, 0.05);
    tools.states[1].position = Vector3(0.05, 0.0, 0.07);
    tools.tick();
    tools.move(lost, {0.05, 0.0, -0.05}, 30);  // around the border of the surface
    tools.move(lost, {0.0, 0.0, -0.05}, 15);
    for (int k = 0; k < 20; ++k) tools.tick();
    INFO("tool " << lost);
    CHECK(tools.reacquired[lost] > 0);
    CHECK(tools.reacquired[1 - lost] == 0);
    CHECK(tools.servo.tick_view().contact_force(lost).z() > 0.0);
  }
}

TEST_CASE("a single point that is grasped is pulled as hard beside another tool as alone", "[haptic][servo][grasp]") {
  test::Pad pad = test::make_pad();
  ServoOptions options;
  options.grasp_buttons = 1;
  options.contact.grasp_radius = 0.0;
  double alone = 0.0;
  for (const std::size_t tools : {1u, 2u}) {
    test::ServoSession session(pad, options, tools);
    if (tools == 2) session.states[1].position = Vector3(0.022, 0.017, test::pad_height + 2.0 * test::sphere_radius);
    session.press(0.5e-3);
    session.states[0].buttons = 1;
    session.tick();
    std::array<double, 2> pulls{};
    for (double& pull : pulls) {
      session.move(session.states[0].position + Vector3(0.0, 0.0, 1e-3), 50);
      pull = -session.servo.tick_view().contact_force(0)[2];
    }
    const double stiffness = (pulls[1] - pulls[0]) / 1e-3;
    // At least a third of that of a flat punch of the same area on a half-space.
    CHECK(stiffness > 2.0 / 3.0 * 1e4 / (1.0 - 0.3 * 0.3) * 0.14 * test::sphere_radius);
    if (tools == 1) alone = stiffness;
    CHECK(std::abs(stiffness - alone) <= 1e-3 * alone);
  }
}

TEST_CASE("the sum of a snapshot's contacts is the contact force, also with grasped points", "[haptic][servo][grasp]") {
  ServoOptions options;
  options.grasp_buttons = 1;
  options.contact.friction = 0.3;
  Tools tools(2, options);
  tools.states[0].position = Vector3(-0.008, 0.0, round_radius + 1e-4);
  tools.states[1].position = Vector3(0.008, 0.001, round_radius + 1e-4);
  tools.tick();
  tools.move(0, {-0.008, 0.0, round_radius - 1e-3}, 40);
  tools.move(1, {0.008, 0.001, round_radius - 1e-3}, 40);
  tools.states[0].buttons = 1;
  const auto look = [&](std::size_t expected) {
    const auto& snapshot = tools.servo.read_snapshot();
    std::array<Vector3, 2> sum{Vector3::Zero(), Vector3::Zero()};
    std::size_t grasped = 0;
    for (const ToolContact& c : snapshot.tool_contacts()) {
      sum[static_cast<std::size_t>(c.tool)] += c.force * c.normal + c.friction;
      CHECK(c.force > 0.0);
      CHECK(std::abs(c.normal.norm() - 1.0) < 1e-12);
      if (c.grasped) ++grasped;
    }
    CHECK(grasped == expected);
    for (std::size_t i : {0u, 1u})
      CHECK((sum[i] - tools.servo.tick_view().contact_force(i)).norm() <=
            1e-9 * tools.servo.tick_view().contact_force(i).norm());
  };
  look(0);
  tools.move(0, {-0.007, 0.0006, round_radius - 1e-3}, 20);  // lateral motion
  REQUIRE(tools.servo.tick_view().is_holding(0));
  look(1);
  tools.move(0, {-0.008, -0.0005, round_radius + 3e-3}, 40);  // pulls: only the grasped point, towards the surface
  CHECK(tools.servo.tick_view().contact_force(0).z() < 0.0);
  look(1);
  tools.move(1, {0.009, 0.001, round_radius - 8e-4}, 20);
  tools.states[1].buttons = 1;
  tools.move(1, {0.009, 0.001, round_radius + 2e-3}, 20);
  look(2);
}

TEST_CASE("more points in contact than rows: no tool starves, and the force is smooth",
          "[haptic][servo][extreme][D11]") {
  test::Pad pad = test::make_pad("z1", 1e4, {20, 20, 4});
  const bool large_first = GENERATE(false, true);
  const SphereTool large{.radius = 40e-3}, small{.radius = 4e-3};
  struct Result {
    double large = 0.0, small = 0.0, jump = 0.0, missing = 0.0;
    bool flagged = false;
  };
  const auto press = [&](int capacity) {
    ServoOptions options;
    options.contact.capacity = capacity;
    HapticServo servo(pad, large_first ? ToolList{large, small} : ToolList{small, large}, options);
    std::array<ToolState, 2> states;
    const std::size_t first = large_first ? 0 : 1, second = 1 - first;
    Result result;
    for (int i = 0; i < 400; ++i) {
      const double down = std::min(1.0, i / 150.0), later = std::clamp((i - 150) / 150.0, 0.0, 1.0);
      states[0].time = states[1].time = 1e-3 * i;
      states[first].position = Vector3(0.008, 0.015, test::pad_height + 40e-3 + 1e-3 - 5e-3 * down);
      states[second].position = Vector3(0.026, 0.015, test::pad_height + 4e-3 + 1e-3 - 3e-3 * later);
      const Status status = servo.tick(states)[0].status;
      const double before = result.large;
      result.large = servo.tick_view().contact_force(first).norm();
      result.jump = std::max(result.jump, std::abs(result.large - before));
      result.flagged = status.has(StatusFlag::degraded_model);
    }
    result.small = servo.tick_view().contact_force(second).norm();
    result.missing = servo.tick_view().missing_depth();
    return result;
  };
  // The large sphere lowers the surface below the small one: the reference has room for all points.
  const Result all = press(512), half = press(96), few = press(24);
  REQUIRE(all.large > 0.4);
  REQUIRE(all.small > 0.05);
  CHECK_FALSE(all.flagged);
  CHECK(all.missing == 0.0);
  CHECK(half.large == Catch::Approx(all.large).epsilon(0.04));
  CHECK(half.small == Catch::Approx(all.small).epsilon(0.02));
  CHECK(half.jump < 1.5 * all.jump);
  CHECK_FALSE(half.flagged);
  CHECK(half.missing == 0.0);
  CHECK(few.large > 0.6 * all.large);
  CHECK(few.small > 0.6 * all.small);
  CHECK(few.missing < 0.3);
}
