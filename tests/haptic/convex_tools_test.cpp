// Convex tools in a servo: symmetries, placement, recovery, allocation and replay.
#include "contact/servo_session.hpp"

#include <palpate/contact/detail/hull_placement.hpp>
#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include "refused.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace palpate;
using test::pad_height;

namespace {

constexpr double radius = 2e-3;

ConvexTool block() {
  return ConvexTool::box({0.012, 0.008, 0.006}, radius);
}
/// A spatula: a plate whose middle is not at the tool's position.
ConvexTool spatula() {
  return ConvexTool({Vector3(2e-3, -3e-3, 0), Vector3(2e-3, 3e-3, 0), Vector3(9e-3, 2e-3, 0), Vector3(9e-3, -2e-3, 0)},
                    radius);
}

void orient(ToolState& state, const Matrix3& rotation) {
  const Quaternion<double> q = quaternion_of(rotation);
  state.orientation = {q.w, q.x, q.y, q.z};
}

/// Smallest distance between the tool and the surface without forces; minus the radius if its core cuts the surface.
double smallest_gap(const ConvexTool& tool, const ContactSurface& surface, const Vector3& at, const Matrix3& rotation) {
  std::vector<Vector3> points;
  for (const Vector3& v : tool.hull().vertices()) points.push_back(at + rotation * v);
  double least = infinity;
  for (const Triangle& t : surface.triangles())
    least = std::min(
        least,
        detail::separate(points, {surface.position(t[0]), surface.position(t[1]), surface.position(t[2])}).distance);
  return least - tool.radius();
}

ServoOptions with_torque() {
  ServoOptions options;
  options.devices = {{.peak_torque = 0.1, .rotational_stiffness = 1.0}};
  return options;
}

}  // namespace

TEST_CASE("rotating model and convex tools together rotates forces and torques", "[haptic][servo][convex]") {
  test::Pad pad = test::make_pad(), rotated = test::make_pad();
  testing::Random random(321);
  for (const ConvexTool& tool : {block(), spatula()}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = testing::random_rotation(random);
    pose.translation() = random.vector<3>(-0.3, 0.3);
    rotated.set_pose(pose);
    HapticServo plain(pad, tool, with_torque()), other(rotated, tool, with_torque());
    ToolState a, b;
    double worst = 0.0, largest = 0.0, worst_torque = 0.0, largest_torque = 0.0, worst_rotation = 0.0;
    for (int i = 0; i < 600; ++i) {
      a.time = b.time = 1e-3 * i;
      a.position = Vector3(0.0137 + 5e-6 * std::max(0, i - 200), 0.0159, pad_height + 4e-3 - 1.5e-5 * std::min(i, 200));
      b.position = pose * a.position;
      const Matrix3 turn = rotation_by({0.05 * std::sin(0.01 * i), 0.03, 1e-3 * i});
      orient(a, turn);
      orient(b, pose.linear() * turn);
      plain.tick(a);
      other.tick(b);
      const Matrix3 to = pose.linear();
      worst = std::max(worst, (to * plain.tick_view().contact_force() - other.tick_view().contact_force()).norm());
      worst_torque =
          std::max(worst_torque, (to * plain.tick_view().contact_torque() - other.tick_view().contact_torque()).norm());
      worst_rotation = std::max(worst_rotation,
                                (to * plain.tick_view().proxy_rotation() - other.tick_view().proxy_rotation()).norm());
      largest = std::max(largest, plain.tick_view().contact_force().norm());
      largest_torque = std::max(largest_torque, plain.tick_view().contact_torque().norm());
    }
    CHECK(largest > 0.05);
    CHECK(largest_torque > 1e-5);
    CHECK(worst <= 1e-6 * largest);
    CHECK(worst_torque <= 1e-6 * largest * 0.01);
    CHECK(worst_rotation <= 1e-6);
    CHECK((other.read_snapshot().rotations[0] - other.tick_view().proxy_rotation()).norm() == 0.0);
  }
}

TEST_CASE("the forces of a convex tool on the tissue and on the tool are in equilibrium", "[haptic][servo][convex]") {
  test::Pad& pad = test::whole_pad();
  ServoOptions options = with_torque();
  options.contact.friction = 0.3;
  HapticServo servo(pad, block(), options);
  ToolState state;
  double worst = 0.0;
  std::vector<double> moments;
  for (int k = 0; k < 500; ++k) {
    state.time = 1e-3 * k;
    state.position = {0.015 + 5e-6 * std::max(0, k - 200), 0.015, pad_height + 4e-3 - 1e-5 * std::min(k, 200)};
    orient(state, rotation_by({0.1, 0.05 * std::sin(0.02 * k), 0.3}));
    servo.tick(state);
    Vector3 sum = servo.tick_view().contact_force(), moment = servo.tick_view().contact_torque(),
            by_contacts = Vector3::Zero();
    for (const VertexForce& f : servo.read_snapshot().vertex_forces()) sum += f.force.in_model_axes();
    for (const ToolContact& c : servo.tick_view().contacts()) {
      const Vector3 total = c.force * c.normal + c.friction;
      by_contacts += total;
      moment -= Vector3(c.point - servo.tick_view().proxy()).cross(total);
    }
    worst = std::max({worst, sum.norm(), (by_contacts - servo.tick_view().contact_force()).norm()});
    moments.push_back(moment.norm());
  }
  const double force = servo.tick_view().contact_force().norm();
  CHECK(servo.tick_view().contact_force()[2] > 0.05);
  CHECK(worst <= 1e-9 * force);
  // The arms are those of the last linearisation: micrometres from the contact points, more in a tick in which points
  // begin or cease to press.
  std::sort(moments.begin(), moments.end());
  CHECK(moments[495] <= 5e-6 * force);
  CHECK(moments.back() <= 5e-4 * force);
}

TEST_CASE("a convex tool that appears inside the body is placed outside of it", "[haptic][servo][convex]") {
  test::Pad& pad = test::whole_pad();
  const ContactSurface& surface = pad.contact_surface();
  const Vector3 origin = pad.to_world() * Vector3(0, 0, 0);
  testing::Random random(322);
  int touching = 0;
  double deepest = infinity;
  HapticServo of_block(pad, block(), {}), of_spatula(pad, spatula(), {});
  for (int run = 0; run < 60; ++run) {
    const ConvexTool tool = run % 2 ? block() : spatula();
    HapticServo& servo = run % 2 ? of_block : of_spatula;
    servo.reset();
    ToolState state;
    state.position = {random.uniform(0.0, 0.03), random.uniform(0.0, 0.03), random.uniform(0.01, 0.03)};
    const Matrix3 turn = testing::random_rotation(random);
    orient(state, turn);
    // Against the surface at rest: before any force has moved it.
    ContactTool placed;
    placed.radius = tool.radius();
    placed.hull = &tool.hull();
    placed.half_length = tool.hull().extent();
    placed.target_rotation = turn;
    detail::place_beside(placed, surface, state.position - origin);
    const double gap = smallest_gap(tool, surface, placed.proxy, placed.rotation);
    deepest = std::min(deepest, gap);
    touching += gap < 1e-6;
    for (const Vector3& v : tool.hull().vertices()) CHECK_FALSE(surface.is_inside(placed.proxy + turn * v));
    const GatedForce first = servo.tick(state);
    CHECK(first.force().allFinite());
  }
  INFO("deepest " << deepest << " m, " << touching << " touching");
  CHECK(deepest >= -0.05 * radius);
  CHECK(touching > 10);
}

TEST_CASE("a convex tool that lost the surface is placed again", "[haptic][servo][convex]") {
  test::AnalyticTissue tissue(10, 0.04, 1e-3);
  HapticServo servo(tissue, block(), {});
  ToolState state;
  int reacquired = 0;
  const auto go = [&](const Vector3& to, int ticks) {
    const Vector3 from = state.position;
    for (int k = 1; k <= ticks; ++k) {
      state.time += 1e-3;
      state.position = from + (to - from) * k / ticks;
      reacquired += servo.tick(state).status.has(StatusFlag::reacquired);
    }
  };
  state.position = {0.06, 0, 0.02};
  go({0.06, 0, -0.02}, 30);  // around the border, then below the surface
  CHECK(reacquired == 0);
  go({0.0, 0, -0.02}, 60);
  CHECK(reacquired > 0);
  CHECK(servo.tick_view().contact_force().z() > 0.0);
}

TEST_CASE("ticks with convex tools do not allocate, and are the same after a reset",
          "[haptic][servo][convex][allocation]") {
  ServoOptions options = with_torque();
  options.contact.friction = 0.3;
  options.contact.sample_spacing = 1.0;
  options.grasp_buttons = 1;
  HapticServo servo(test::whole_pad(), {block(), spatula(), SphereTool{.radius = radius}}, options);
  std::array<ToolState, 3> states;
  std::vector<Vector3> before, after;
  std::uint64_t calls = 0;
  int pressed = 0;
  StatusCounters flags;
  const auto run = [&](std::vector<Vector3>& forces) {
    forces.reserve(3000);
    const testing::AllocationScope scope;
    for (int k = 0; k < 1000; ++k) {
      const double z = pad_height + 4e-3 - 1e-5 * std::min(k, 250);
      states[0].position = {0.012, 0.01 + 5e-6 * k, z};
      states[1].position = {0.012, 0.022, z - 1e-3};
      states[2].position = {0.025, 0.025, z - 1e-3};
      for (std::size_t i = 0; i < 3; ++i) {
        states[i].time = 1e-3 * k;
        states[i].valid = k != 600;
        states[i].buttons = k > 300 && k < 350;
        orient(states[i], rotation_by({0.1 * std::sin(0.01 * k), 0.02, 2e-3 * k}));
      }
      if (k == 700) states[0].position += Vector3(0.01, 0, -0.02);
      if (k == 800) states[0].orientation[0] = std::nan("");
      for (const GatedForce& f : servo.tick(states)) {
        forces.push_back(f.force());
        flags.count(f.status);
        pressed += f.force().norm() > 1e-3;
      }
    }
    calls += scope.allocations() + scope.frees();
  };
  run(before);
  servo.reset();
  run(after);
  CHECK(calls == 0);
  CHECK(pressed > 2000);
  CHECK(flags[StatusFlag::reacquired] > 0);
  CHECK(flags[StatusFlag::non_finite_input] > 0);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < before.size(); ++i) equal += test::same(before[i], after[i]);
  CHECK(equal == before.size());
}

TEST_CASE("a rounding too small for the facets is refused", "[haptic][servo][convex]") {
  const auto small = [](double rounding) { return ConvexTool::box({0.012, 0.008, 0.006}, rounding); };
  const SetupProblem refused = test::refusal([&] { HapticServo(test::whole_pad(), small(1e-4), {}); });
  CHECK(refused.kind == SetupErrorKind::bad_argument);
  CHECK(refused.ids.size() == 2);
  CHECK_NOTHROW(HapticServo(test::whole_pad(), small(4e-4), {}));
}
