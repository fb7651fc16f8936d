// A tool that grasps a pad: a group of vertices that keep their places on the tool.
#include "contact/servo_session.hpp"
#include "contact/tool_session.hpp"

#include <palpate/core/setup_error.hpp>

#include "catch.hpp"

using namespace palpate;
using test::AnalyticTissue;
using test::round_tool;
using test::ToolSession;

namespace {

constexpr double pad_radius = 4e-3, pad_own = 1e-3, pad_common = 5e-4;

ContactParameters pad_of(double radius) {
  ContactParameters p;
  p.grasp_radius = radius;
  return p;
}

/// The vertices with grasped rows.
std::vector<int> grasped_vertices(const ToolSession& s, int tool = 0) {
  std::vector<int> grasped;
  for (const Contact& c : s.problem.contacts())
    if (c.grasped && c.tool == tool) grasped.push_back(c.vertices[0]);
  std::ranges::sort(grasped);
  grasped.erase(std::unique(grasped.begin(), grasped.end()), grasped.end());
  return grasped;
}

}  // namespace

TEST_CASE("a pad holds the vertices within its radius, and all of them follow the tool", "[contact][grasp][pad]") {
  AnalyticTissue tissue(40, 0.04, pad_own, pad_common);  // vertices 1 mm apart, one at the origin
  ToolSession s(tissue, {round_tool(pad_radius, {0, 0, pad_radius + 1e-4}, 0.0)}, pad_of(1.1e-3));
  s.tools[0].grasping = true;
  s.tick();
  REQUIRE(s.problem.is_holding(0));
  const std::vector<int> grasped = grasped_vertices(s);
  CHECK(grasped.size() >= 5);  // the vertex in the middle and its neighbours along the axes
  for (const int v : grasped) CHECK(tissue.contact_surface().position(v).norm() < 1.5e-3);
  CHECK(s.force().norm() < 1e-9);  // grasped where it is
  const auto n = static_cast<double>(grasped.size());
  for (const Vector3& by : {Vector3(0, 0, 3e-3), Vector3(5e-3, -2e-3, 6e-3), Vector3(-8e-3, 0, 1e-3)}) {
    s.move(0, Vector3(0, 0, pad_radius + 1e-4) + by, 60);
    // n springs on one common spring, all displaced by the same vector
    CHECK((s.force() + by / (pad_own / n + pad_common)).norm() < 1e-6 * s.force().norm());
    const auto x = test::deformed_surface(tissue, s.problem.vertex_forces());
    for (const int v : grasped)
      CHECK((x[static_cast<std::size_t>(v)] - tissue.contact_surface().position(v) - by).norm() < 1e-8);
  }
  s.move(0, {0, 0, pad_radius + 3e-3}, 60);
  s.tools[0].grasping = false;
  s.tick();
  CHECK_FALSE(s.problem.is_holding(0));
  CHECK(s.force().isZero(0.0));
}

TEST_CASE("a pad holds eight vertices at most, a radius of zero one point", "[contact][grasp][pad]") {
  AnalyticTissue tissue(40, 0.04, pad_own);
  for (const double radius : {0.0, 3e-3}) {
    ToolSession s(tissue, {round_tool(pad_radius, {0, 0, pad_radius + 1e-4}, 0.0)}, pad_of(radius));
    s.tools[0].grasping = true;
    s.tick();
    CHECK(grasped_vertices(s).size() == (radius > 0.0 ? 8 : 1));
  }
  CHECK_THROWS_AS(ToolSession(tissue, {}, pad_of(-1e-3)), SetupError);
  CHECK_THROWS_AS(ToolSession(tissue, {}, pad_of(std::numeric_limits<double>::quiet_NaN())), SetupError);
}

TEST_CASE("grasping a pad while pressing changes the force by little", "[contact][grasp][pad]") {
  AnalyticTissue tissue(40, 0.04, pad_own, pad_common);
  ToolSession s(tissue, {round_tool(pad_radius, {0, 0, pad_radius}, 0.0)}, pad_of(2e-3));
  s.move(0, {0, 0, pad_radius - 1e-3}, 40);
  s.settle();
  const Vector3 pressed = s.force();
  REQUIRE(pressed[2] > 0.1);
  s.tools[0].grasping = true;
  s.settle();
  CHECK((s.force() - pressed).norm() < 1e-3 * pressed.norm());
}

TEST_CASE("two tools hold a pad each and pull the tissue apart", "[contact][grasp][pad]") {
  AnalyticTissue tissue(40, 0.04, pad_own, pad_common);
  ToolSession s(
      tissue, {round_tool(pad_radius, {-0.01, 0, pad_radius}, 0.0), round_tool(pad_radius, {0.01, 0, pad_radius}, 0.0)},
      pad_of(2e-3));
  s.tools[0].grasping = s.tools[1].grasping = true;
  s.settle(2);
  REQUIRE(grasped_vertices(s, 0).size() == grasped_vertices(s, 1).size());
  const std::array<Vector3, 2> by{Vector3(-4e-3, 0, 3e-3), Vector3(3e-3, 1e-3, 3e-3)};
  for (std::size_t i = 0; i < 2; ++i) s.move(i, s.tools[i].target + by[i], 60);
  s.settle(2);
  // own / n F_i + common (F_0 + F_1) = -by_i
  const double part = pad_own / static_cast<double>(grasped_vertices(s, 0).size());
  const Vector3 sum = -(by[0] + by[1]) / (part + 2.0 * pad_common);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK((s.force(i) + (by[i] + pad_common * sum) / part).norm() < 1e-5 * s.force(i).norm());
}

TEST_CASE("a tool that presses grasps the point in the middle of those it presses", "[contact][grasp]") {
  test::Pad pad = test::make_pad();
  ServoOptions options;
  options.force_limits = test::open_gate();
  options.grasp_buttons = 1;
  for (const Vector3& place : {Vector3(0.0131, 0.0147, 0), Vector3(0.0152, 0.0163, 0), Vector3(0.0117, 0.0158, 0),
                               Vector3(0.0163, 0.0139, 0), Vector3(0.0149, 0.0151, 0)}) {
    test::ServoSession session(pad, options);
    ToolState& state = session.states[0];
    state.position = place + Vector3(0, 0, test::pad_height + test::sphere_radius);
    for (int k = 0; k < 40; ++k) {
      state.position[2] -= 5e-5;
      session.tick();
    }
    state.buttons = 1;
    session.tick();
    int grasped = 0;
    for (const ToolContact& c : session.servo.read_snapshot().tool_contacts())
      if (c.grasped) {
        ++grasped;
        CHECK((c.point - state.position).head<2>().norm() < 0.25 * test::sphere_radius);  // of 0.7 radii
      }
    CHECK(grasped == 1);
  }
}

TEST_CASE("a flat tool that grasped a point pulls it up, and holds it, with a force of its own", "[contact][grasp]") {
  test::Pad pad = test::make_pad();
  ServoOptions options;
  options.force_limits = test::open_gate();
  options.grasp_buttons = 1;
  for (const double side : {4e-3, 6e-3, 8e-3, 10e-3}) {
    HapticServo servo(pad, ConvexTool::box(Vector3(side, side, 4e-3), 1e-3), options);
    ToolState state;
    state.position = Vector3(0.0131, 0.0147, test::pad_height + 2e-3);
    const auto move = [&](double up) {
      for (int k = 0; k < 100; ++k) {
        state.position[2] += 1e-2 * up;
        state.time += 1e-3;
        CHECK_FALSE(servo.tick(state).status.has(StatusFlag::solver_not_converged));
      }
    };
    move(-0.5e-3);
    state.buttons = 1;
    move(0.0);
    move(2.5e-3);
    move(0.0);
    CHECK(servo.tick_view().contact_force().z() < -1e-3);
  }
}

TEST_CASE("a pad smaller than the facet that it grasps is flagged", "[contact][grasp][pad]") {
  for (const int cells : {3, 30}) {  // facets of 10 and 1 mm
    test::Pad pad = test::make_pad("z1", 1e4, {cells, cells, 3});
    ServoOptions options;
    options.force_limits = test::open_gate();
    options.grasp_buttons = 1;
    options.contact.grasp_radius = 2e-3;
    test::ServoSession session(pad, options);
    ToolState& state = session.states[0];
    state.position = Vector3(0.0131, 0.0147, test::pad_height + test::sphere_radius - 3e-4);
    session.tick();
    state.buttons = 1;
    const Status status = session.tick().status;
    CHECK(session.servo.tick_view().is_holding());
    CHECK(status.has(StatusFlag::coarse_contact) == (cells == 3));
  }
}
