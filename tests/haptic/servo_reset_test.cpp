// A session after reset starts as a new one does, and a moving tissue receives zero forces.
#include <palpate/haptic/haptic_servo.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <bit>
#include <cmath>

using namespace palpate;

namespace {

/// Springs that store the sum of the last forces.
struct ListeningTissue : test::AnalyticTissue {
  using AnalyticTissue::AnalyticTissue;
  Status begin_tick() noexcept { return {}; }
  void end_tick(std::span<const VertexForce> forces) noexcept {
    pressing = Vector3::Zero();
    for (const VertexForce& f : forces) pressing += f.force.in_model_axes();
    ++calls;
  }

  Vector3 pressing = Vector3::Zero();
  int calls = 0;
};
static_assert(TissueModel<ListeningTissue> && AnnouncesChanges<ListeningTissue>);
static_assert(!AnnouncesChanges<test::AnalyticTissue>);

/// Presses, slides, lifts, jumps, loses its reading and grasps: everything that leaves state behind.
ToolState wild_state(int tick, int tool) {
  const double t = 1e-3 * tick, phase = 1.7 * tool;
  ToolState state;
  state.time = t;
  state.position = Vector3(0.015 + 6e-3 * std::sin(7.0 * t + phase), 0.015 + 6e-3 * std::sin(11.0 * t + 2.0 * phase),
                           test::pad_height + 3e-3 + 2.5e-3 * std::sin(23.0 * t + phase));
  if (tick % 400 > 390) state.position[2] += 0.02;
  state.orientation = {std::cos(0.3 * std::sin(5.0 * t)), std::sin(0.3 * std::sin(5.0 * t)), 0.0, 0.0};
  state.valid = tick % 700 < 690;
  state.buttons = tick % 900 > 600 ? 1 : 0;
  return state;
}

/// Bit patterns of all forces and torques of a run.
std::vector<std::uint64_t> play(HapticServo& servo, int tools) {
  std::vector<std::uint64_t> bits;
  std::vector<ToolState> states(static_cast<std::size_t>(tools));
  for (int tick = 0; tick < 2500; ++tick) {
    for (int i = 0; i < tools; ++i) states[static_cast<std::size_t>(i)] = wild_state(tick, i);
    for (const GatedForce& f : servo.tick(states))
      for (int c = 0; c < 3; ++c) {
        bits.push_back(std::bit_cast<std::uint64_t>(f.force()[c]));
        bits.push_back(std::bit_cast<std::uint64_t>(f.torque()[c]));
      }
  }
  return bits;
}

void check_replay(HapticServo& servo, int tools) {
  const auto first = play(servo, tools);
  servo.reset();
  const auto second = play(servo, tools);
  std::size_t pressing = 0, different = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] != 0) ++pressing;
    if (first[i] != second[i]) ++different;
  }
  CHECK(pressing > first.size() / 6);
  CHECK(different == 0);
}

}  // namespace

TEST_CASE("a session after reset gives bitwise the same run", "[haptic][servo]") {
  ServoOptions options;
  options.contact.friction = GENERATE(0.0, 0.4);
  options.grasp_buttons = GENERATE(0u, 1u);
  INFO("friction " << options.contact.friction << ", grasp buttons " << options.grasp_buttons);
  SECTION("a sphere") {
    HapticServo servo(test::whole_pad(), SphereTool{.radius = test::sphere_radius}, options);
    check_replay(servo, 1);
  }
  SECTION("a capsule with torque, and another") {
    options.device.peak_torque = 0.1;
    options.device.rotational_stiffness = 1.0;
    const CapsuleTool capsule(3e-3, 6e-3, Vector3(1.0, 0.0, 0.0));
    HapticServo servo(test::whole_pad(), std::vector<CapsuleTool>{capsule, capsule}, options);
    check_replay(servo, 2);
  }
  SECTION("more contacts than there is room for") {
    options.contact.capacity = 6;
    HapticServo servo(test::whole_pad(), std::vector<SphereTool>(2, SphereTool{.radius = test::sphere_radius}),
                      options);
    check_replay(servo, 2);
  }
}

TEST_CASE("a reset reports to the tissue that nothing presses any more", "[haptic][servo]") {
  ListeningTissue tissue(10, 0.04, 1e-3);
  HapticServo servo(tissue, SphereTool{.radius = 5e-3});
  ToolState state;
  for (int k = 0; k < 50; ++k) {
    state.time = 1e-3 * k;
    state.position = Vector3(0.0, 0.0, 5.5e-3 - 4e-5 * k);
    servo.tick({&state, 1});
  }
  CHECK(tissue.calls == 50);
  CHECK(tissue.pressing.z() < -1e-3);
  CHECK(!servo.read_snapshot().vertex_forces().empty());
  servo.reset();
  CHECK(servo.read_snapshot().vertex_forces().empty());  // a renderer shows no dent any more
  CHECK(servo.read_snapshot().tool_contacts().empty());
  CHECK(tissue.calls == 51);
  CHECK(tissue.pressing == Vector3::Zero());
  CHECK(servo.contacts().empty());
}
