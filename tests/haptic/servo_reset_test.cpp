// A session after reset starts as a new one does, and a moving tissue receives zero forces.
#include <palpate/haptic/haptic_servo.hpp>

#include "contact/servo_session.hpp"

#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "catch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

using namespace palpate;

namespace {

/// Springs that store the sum of the last forces.
struct ListeningTissue : test::AnalyticTissue {
  using AnalyticTissue::AnalyticTissue;
  Status begin_tick() noexcept { return {}; }
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce>) noexcept {
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

/// Bit patterns of the contact forces of a small sphere that presses large facets and slides, with steps of the tissue.
std::vector<std::uint64_t> press_and_slide(HapticServo& servo, MovingTissue& tissue) {
  std::vector<std::uint64_t> bits;
  double due = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    const double t = 1e-3 * tick;
    for (; due <= t; due += tissue.step()) tissue.advance();
    ToolState state;
    state.time = t;
    state.position = Vector3(0.012 + 2e-5 * tick, 0.014, test::pad_height + 2.5e-3 - 2e-3 * std::sin(15.0 * t));
    servo.tick(state);
    for (int c = 0; c < 3; ++c) bits.push_back(std::bit_cast<std::uint64_t>(servo.tick_view().contact_force()[c]));
  }
  return bits;
}

template <class Solver>
using MovingPad = HapticFEModel<Tet4, NeoHookean, Solver>;

template <class Solver>
MovingPad<Solver> make_moving_pad() {
  return MovingPad<Solver>(box_tet4(Vector3(0.03, 0.03, test::pad_height), {3, 3, 2}, BoxSplit::six),
                           Scene().fix("z0").touch("z1").gravity({0.0, 0.0, -9.81}), NeoHookean{5e3, 0.4, 1000.0});
}

}  // namespace

TEMPLATE_TEST_CASE("sessions on moving tissue after reset give bitwise the same run, also with another servo",
                   "[haptic][servo][soft]", Implicit<QuasiNewton<>>, Implicit<Newton>, Explicit<CentralDifference>) {
  MovingPad<TestType> tissue = make_moving_pad<TestType>();
  ServoOptions options;
  options.contact.friction = GENERATE(0.0, 0.4);
  const SphereTool tool{.radius = 2e-3};
  std::optional<HapticServo> servo(std::in_place, tissue, tool, options);
  const auto first = press_and_slide(*servo, tissue);
  CHECK(std::ranges::count(first, std::uint64_t{0}) < 450);  // of 900
  SECTION("the servo is reset before the tissue") {
    servo->reset();
    tissue.reset();
  }
  SECTION("the servo is reset after the tissue") {
    tissue.reset();
    servo->reset();
  }
  SECTION("another servo") {
    tissue.reset();
    servo.reset();
    servo.emplace(tissue, tool, options);
  }
  CHECK((press_and_slide(*servo, tissue) == first));
}

TEMPLATE_TEST_CASE("a session after reset gives bitwise the same run, whatever columns were computed before",
                   "[haptic][servo][columns]", SparseCholesky, ConjugateGradient, Condensed<DenseCholesky>) {
  auto pad = test::make_pad<HapticFEModel<Tet4, LinearElastic, TestType>>("surface", 1e4, {4, 4, 3});
  ServoOptions options;
  options.contact.friction = GENERATE(0.0, 0.4);
  HapticServo servo(pad, std::vector<SphereTool>(2, SphereTool{.radius = test::sphere_radius}), options);
  const auto first = play(servo, 2);
  CHECK(std::ranges::count(first, std::uint64_t{0}) < static_cast<std::ptrdiff_t>(first.size()));
  servo.reset();
  pad.reset();
  CHECK((play(servo, 2) == first));
}

TEMPLATE_TEST_CASE("columns that were replaced change a session after reset by the accuracy of the solver",
                   "[haptic][servo][columns]", SparseCholesky, ConjugateGradient) {
  SetupOptions few;
  few.columns = ColumnFill::synchronous;
  few.compliance_slots = 24;  // of 82 vertices
  auto pad = test::make_pad<HapticFEModel<Tet4, LinearElastic, TestType>>("surface", 1e4, {4, 4, 3}, few);
  HapticServo servo(pad, SphereTool{.radius = test::sphere_radius});
  const auto first = play(servo, 1);
  servo.reset();
  pad.reset();
  const auto second = play(servo, 1);
  double largest = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto a = std::bit_cast<double>(first[i]), b = std::bit_cast<double>(second[i]);
    largest = std::max(largest, std::abs(a));
    difference = std::max(difference, std::abs(a - b));
  }
  CHECK(largest > 0.1);
  CHECK(difference <= (std::same_as<TestType, ConjugateGradient> ? 1e-5 : 1e-10) * largest);
}

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
    options.devices = {{.peak_torque = 0.1, .rotational_stiffness = 1.0}};
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
  CHECK(servo.tick_view().contacts().empty());
}
