// Convex tools compared with closed forms, and with spheres and capsules.
#include "contact/servo_session.hpp"
#include "contact/tool_session.hpp"

#include <palpate/contact/detail/tool_placement.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using test::AnalyticTissue;
using test::ToolSession;

namespace {

struct Wrench {
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
};

ContactTool tool_of(const ConvexHull& hull, double radius, const Vector3& at, double compliance = 0.0) {
  ContactTool tool = test::round_tool(radius, at, compliance, hull.extent());
  tool.hull = &hull;
  return tool;
}

/// A rounded box at a pose: half sizes of its core.
struct Box {
  Vector3 half;
  double radius;
  Vector3 at;
  Matrix3 turn;

  /// Depth of a point in the rounded box.
  double depth(const Vector3& x) const {
    const Vector3 q = (turn.transpose() * Vector3(x - at)).cwiseAbs() - half;
    return radius - q.cwiseMax(0.0).norm() - std::min(q.maxCoeff(), 0.0);
  }
  /// From a point towards the box: by finite differences of the depth.
  Vector3 direction(const Vector3& x) const {
    const double h = 1e-7 * radius;
    Vector3 d;
    for (int i = 0; i < 3; ++i) d[i] = (depth(x + h * Vector3::Unit(i)) - depth(x - h * Vector3::Unit(i))) / (2.0 * h);
    return d.normalized();
  }
};

/// Independent springs: every vertex within the box pushes it along the shortest way out, at the surface of the box.
Wrench wrench_of_springs(const AnalyticTissue& tissue, const Box& box) {
  Wrench w;
  for (const Vector3& x : tissue.contact_surface().positions()) {
    const double depth = box.depth(x);
    if (depth <= 0.0) continue;
    const Vector3 f = depth / tissue.own() * box.direction(x);
    w.force += f;
    w.torque += (x - box.at).cross(f);
  }
  return w;
}

double energy_of_springs(const AnalyticTissue& tissue, const Box& box) {
  double e = 0.0;
  for (const Vector3& x : tissue.contact_surface().positions()) {
    const double depth = std::max(0.0, box.depth(x));
    e += 0.5 * depth * depth / tissue.own();
  }
  return e;
}

}  // namespace

TEST_CASE("a rounded box on springs: force and torque equal the closed form in any orientation", "[contact][convex]") {
  testing::Random random(311);
  const double radius = 1.5e-3;
  double worst = 0.0, worst_torque = 0.0;
  std::size_t most = 0;
  for (int run = 0; run < 40; ++run) {
    AnalyticTissue tissue(20, 0.03, 2e-2);  // 1.5 mm apart
    const Vector3 half(4e-3, 2.5e-3, run % 2 == 0 ? 1e-3 : 0.0);
    std::vector<Vector3> corners;
    for (int k = 0; k < 8; ++k)
      corners.emplace_back(k & 1 ? half[0] : -half[0], k & 2 ? half[1] : -half[1], k & 4 ? half[2] : -half[2]);
    const ConvexHull hull(corners);
    const Matrix3 turn = rotation_by({random.uniform(-3.1, 3.1), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)});
    double lowest = 0.0;
    for (const Vector3& v : corners) lowest = std::min(lowest, (turn * v)[2]);
    const Vector3 end(random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3),
                      radius - lowest - random.uniform(2e-4, 9e-4));
    ContactTool tool = tool_of(hull, radius, end + Vector3(0, 0, 2e-3));
    tool.rotation = tool.target_rotation = turn;
    ToolSession s(tissue, {tool});
    s.move(0, end, 100);
    s.settle();
    const Wrench exact = wrench_of_springs(tissue, {half, radius, end, turn});
    worst = std::max(worst, (s.force() - exact.force).norm() / exact.force.norm());
    worst_torque = std::max(worst_torque, (s.tools[0].torque - exact.torque).norm() / (5e-3 * exact.force.norm()));
    most = std::max(most, s.problem.contacts().size());
    CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
  }
  INFO("error of force " << worst << ", of torque " << worst_torque << ", up to " << most << " contacts");
  CHECK(worst <= 1e-4);
  CHECK(worst_torque <= 1e-4);
  CHECK(most >= 16);
}

TEST_CASE("a rounded box that rotates over springs", "[contact][convex]") {
  const double radius = 1.5e-3;
  const Vector3 half(4e-3, 2.5e-3, 1e-3);
  const ConvexTool box = ConvexTool::box(2.0 * half + Vector3(2 * radius, 2 * radius, 2 * radius), radius);
  AnalyticTissue tissue(20, 0.03, 2e-2);
  ToolSession s(tissue, {tool_of(box.hull(), radius, {3e-4, 2e-4, 2.6e-3})});
  s.move(0, {3e-4, 2e-4, 2.1e-3}, 100);
  double worst = 0.0;
  for (int k = 1; k <= 500; ++k) {  // half a rotation about the vertical, with a changing tilt
    const Matrix3 turn = rotation_by(Vector3(0, 0, 0.0063 * k)) * rotation_by(Vector3(0, 0.05 * std::sin(0.05 * k), 0));
    s.tick(0, s.tools[0].target, turn);
    const Wrench exact = wrench_of_springs(tissue, {half, radius, s.tools[0].target, turn});
    worst = std::max(worst, (s.force() - exact.force).norm() / exact.force.norm());
    worst = std::max(worst, (s.tools[0].torque - exact.torque).norm() / (5e-3 * exact.force.norm()));
  }
  INFO("worst " << worst);
  CHECK(worst <= 5e-3);
  CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
}

TEST_CASE("force and torque of a rounded box are minus the gradient of the energy", "[contact][convex]") {
  testing::Random random(312);
  const double radius = 1.5e-3;
  const Vector3 half(4e-3, 2.5e-3, 1e-3);
  const ConvexTool box = ConvexTool::box(2.0 * half + Vector3(2 * radius, 2 * radius, 2 * radius), radius);
  double worst = 0.0;
  for (int run = 0; run < 20; ++run) {
    AnalyticTissue tissue(20, 0.03, 2e-2);
    const Vector3 at(random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), 2.1e-3);
    const Matrix3 turn = rotation_by({random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-3, 3)});
    ContactTool tool = tool_of(box.hull(), radius, at + Vector3(0, 0, 2e-3));
    tool.rotation = tool.target_rotation = turn;
    ToolSession s(tissue, {tool});
    s.move(0, at, 100);
    s.settle();
    const double h = 1e-6;
    const auto energy = [&](const Vector3& shift, const Vector3& by) {
      return energy_of_springs(tissue, {half, radius, at + shift, rotation_by(by) * turn});
    };
    for (int i = 0; i < 3; ++i) {
      const Vector3 e = Vector3::Unit(i), none = Vector3::Zero();
      const double force = -(energy(h * e, none) - energy(-h * e, none)) / (2.0 * h);
      const double torque = -(energy(none, 1e-4 * e) - energy(none, -1e-4 * e)) / 2e-4;
      worst = std::max(worst, std::abs(s.force()[i] - force) / s.force().norm());
      worst = std::max(worst, std::abs(s.tools[0].torque[i] - torque) / (5e-3 * s.force().norm()));
    }
  }
  INFO("worst " << worst);
  CHECK(worst <= 2e-3);
}

TEST_CASE("a rounded box pressed flat: equal contacts, force along the normal, no torque", "[contact][convex]") {
  const double radius = 1e-3, own = 2e-2, depth = 5e-4;
  AnalyticTissue tissue(20, 0.04, own);  // 2 mm apart
  const ConvexTool box = ConvexTool::box({0.011, 0.007, 0.004}, radius);
  ToolSession s(tissue, {tool_of(box.hull(), radius, {0, 0, 2.5e-3})});
  s.move(0, {0, 0, 2e-3 - depth}, 100);
  s.settle();
  // Its flat face covers 5 x 3 vertices; the next ones are 0.5 mm out of the rounding's reach.
  double sum = 0.0;
  int pressed = 0;
  for (const Contact& c : s.problem.contacts()) {
    pressed += c.force > 0.0;
    sum += c.force;
    CHECK_THAT(c.force * own, WithinAbs(c.force > 0.0 ? depth : 0.0, 2e-6 * depth));
  }
  CHECK(pressed == 15);
  CHECK_THAT(s.force()[2], WithinRel(15 * depth / own, 2e-6));
  CHECK_THAT(s.force()[2], WithinRel(sum, 1e-12));
  CHECK(s.force().head<2>().norm() <= 1e-12 * sum);
  CHECK(s.tools[0].torque.norm() <= 1e-12 * sum);
}

TEST_CASE("points deep inside the core of a convex tool get finite forces outward", "[contact][convex]") {
  const double radius = 2e-4, own = 2e-2;
  AnalyticTissue tissue(20, 0.04, own);
  const ConvexTool box = ConvexTool::box({0.0095, 0.0055, 0.006}, radius);
  ToolSession s(tissue, {tool_of(box.hull(), radius, {0, 0, 3.3e-3})});
  s.move(0, {0, 0, 1.5e-3}, 400);  // 1.5 mm deep, seven times the rounding
  s.settle();
  CHECK_THAT(s.force()[2], WithinRel(15 * 1.5e-3 / own, 2e-6));
  CHECK(s.force().head<2>().norm() <= 1e-9);
  CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
  s.move(0, {0, 0, 3.3e-3}, 400);
  CHECK(s.force() == Vector3::Zero());
}

TEST_CASE("a flat tool on a support has the points it needs: finer ones in its plane are no doubt",
          "[contact][convex]") {
  const double radius = 1e-3;
  AnalyticTissue support(40, 0.04, 1e-12);  // hardly yields
  const ConvexTool plate = ConvexTool::box({0.007, 0.007, 0.004}, radius);
  ToolSession s(support, {tool_of(plate.hull(), radius, {1e-4, 2e-4, 2.5e-3}, 1e-3)}, {}, radius);
  s.move(0, {1e-4, 2e-4, 1e-3}, 200);
  s.settle();
  s.status = {};
  s.settle();
  CHECK_THAT(s.force()[2], WithinRel(1.0, 1e-3));
  CHECK_FALSE(s.status.has(StatusFlag::degraded_model));
  CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
}

TEST_CASE("a hull of one point is a sphere, of two points a capsule", "[contact][convex]") {
  const double friction = GENERATE(0.0, 0.4), rotational = GENERATE(0.0, 0.4);
  const double half = GENERATE(0.0, 6e-3), radius = 3e-3;
  const Vector3 axis = Vector3(1.0, 0.3, 0.1).normalized();
  const ConvexHull hull(std::vector<Vector3>{-half * axis, half * axis});
  AnalyticTissue tissue(20, 0.03, 2e-2, 1e-3);
  ContactParameters parameters;
  parameters.friction = friction;
  parameters.maximum_iterations = 100;
  parameters.force_tolerance = 1e-12;
  ContactTool round = test::round_tool(radius, {0, 0, 4e-3}, 1e-3, half, axis);
  round.rotational_compliance = rotational;
  ContactTool convex = round;
  convex.hull = &hull;
  convex.half_length = std::max(hull.extent(), 1e-300);  // not treated as a sphere
  ToolSession a(tissue, {round}, parameters, radius), b(tissue, {convex}, parameters, radius);
  double worst = 0.0, worst_torque = 0.0, largest = 0.0;
  for (int k = 0; k < 600; ++k) {
    const Vector3 target(5e-6 * std::max(0, k - 200), 0, 4e-3 - 1e-5 * std::min(k, 200));
    const Matrix3 turn = rotation_by(Vector3(0, 0.05 * std::sin(0.01 * k), 1e-3 * k));
    a.tick(0, target, turn);
    b.tick(0, target, turn);
    largest = std::max(largest, a.force().norm());
    worst = std::max(worst, (a.force() - b.force()).norm());
    worst_torque = std::max(worst_torque, (a.tools[0].torque - b.tools[0].torque).norm());
  }
  INFO("half length " << half << ", friction " << friction << ", difference " << worst << " N of " << largest);
  CHECK(largest > 0.01);
  // Friction is solved to 1e-4: a capsule at poses that differ by rounding has forces that differ by as much as here.
  // Without it, a point that penetrates by less than 1e-5 of its dent may have a row in one session only.
  const double tolerance = friction > 0.0 ? 2e-2 : 1e-7;
  CHECK(worst <= tolerance * largest);
  CHECK(worst_torque <= tolerance * largest * (radius + half));
}

TEST_CASE("the edge of a rounded box presses like a capsule", "[contact][convex]") {
  const double radius = 1.5e-3, half = 6e-3, side = 8e-3;
  // Its lowest edge is below the tool's position by half of the diagonal of the square.
  const double below = (0.5 * side) * std::sqrt(2.0);
  AnalyticTissue tissue(24, 0.03, 2e-2, 1e-3);
  const ConvexTool box = ConvexTool::box({2 * (half + radius), side + 2 * radius, side + 2 * radius}, radius);
  const Matrix3 on_edge = rotation_by(Vector3(std::atan(1.0), 0, 0));
  ContactTool edge = tool_of(box.hull(), radius, {0, 0, below + 2e-3}, 1e-3);
  edge.rotation = edge.target_rotation = on_edge;
  ToolSession a(tissue, {edge}), b(tissue, {test::round_tool(radius, {0, 0, 2e-3}, 1e-3, half)});
  double worst = 0.0, worst_torque = 0.0;
  for (int k = 0; k < 600; ++k) {
    const Vector3 target(4e-6 * std::max(0, k - 200), 2e-6 * std::max(0, k - 200), 2e-3 - 5e-6 * std::min(k, 200));
    a.tick(0, target + Vector3(0, 0, below), on_edge);
    b.tick(0, target);
    const Vector3 lever(0, 0, -below);
    worst = std::max(worst, (a.force() - b.force()).norm());
    worst_torque = std::max(worst_torque, (a.tools[0].torque - b.tools[0].torque - lever.cross(a.force())).norm());
  }
  INFO("difference " << worst << " N of " << b.force().norm());
  CHECK(b.force()[2] > 0.05);
  CHECK(worst <= 1e-6 * b.force()[2]);
  CHECK(worst_torque <= 1e-6 * b.force()[2] * below);
}

TEST_CASE("the coupling for rotations of a plate is a spring in series", "[contact][convex][torque]") {
  // Three rows of vertices under a plate; a rotation about y lowers one end.
  const double radius = 2e-3, a = 0.05, own = 1e-3, coupling = 5e-4, rotational = 0.4, depth = 5e-4, tilt = 2e-3;
  AnalyticTissue tissue(2, 2.0 * a, own);  // at -a, 0, a
  const ConvexTool plate = ConvexTool::box({0.14, 0.14, 2 * radius}, radius);
  ContactTool tool = tool_of(plate.hull(), radius, {0, 0, radius + 1e-3}, coupling);
  tool.rotational_compliance = rotational;
  ToolSession s(tissue, {tool});
  s.move(0, {0, 0, radius - depth}, 100);
  CHECK(s.tools[0].torque.norm() <= 1e-9);
  for (int k = 1; k <= 20; ++k) s.tick(0, s.tools[0].target, rotation_by(Vector3(0, 0.05 * k * tilt, 0)));
  s.settle();
  const double stiffness = 6.0 * a * a / own;  // [N m/rad] of the rows at both ends
  CHECK_THAT(s.force()[2], WithinRel(9.0 * depth / (own + 9.0 * coupling), 2e-3));
  CHECK_THAT(s.tools[0].torque[1], WithinRel(-tilt * stiffness / (1.0 + rotational * stiffness), 2e-3));
}

TEST_CASE("friction of a rounded box sticks, then slides with the coefficient", "[contact][convex][friction]") {
  const double radius = 1e-3, own = 2e-2;
  AnalyticTissue tissue(20, 0.04, own);
  ContactParameters parameters;
  parameters.friction = 0.3;
  const ConvexTool box = ConvexTool::box({0.011, 0.007, 0.004}, radius);
  ToolSession s(tissue, {tool_of(box.hull(), radius, {0, 0, 2.5e-3})}, parameters);
  s.move(0, {0, 0, 1.8e-3}, 200);
  const double normal = s.force()[2];
  s.move(0, {2e-5, 0, 1.8e-3}, 20);
  CHECK_THAT(s.force()[0], WithinRel(-15 * 2e-5 / own, 1e-6));  // the springs shear
  s.move(0, {5e-4, 0, 1.8e-3}, 480);
  CHECK_THAT(s.force()[0], WithinRel(-0.3 * normal, 1e-4));
  CHECK_THAT(s.force()[2], WithinRel(normal, 1e-4));
}

TEST_CASE("a plate that just touches is not flagged, whatever rounding does", "[contact][convex]") {
  test::Pad pad = test::make_pad("z1", 1e4, {3, 3, 2});
  ServoOptions options;
  options.force_limits = test::open_gate();
  options.contact.friction = GENERATE(0.0, 0.3);
  for (const double side : {5e-3, 7e-3, 11e-3, 13e-3, 17e-3}) {
    HapticServo servo(pad, ConvexTool::box(Vector3(side, side, 4e-3), 1e-3), options);
    ToolState state;
    state.position = Vector3(0.0131, 0.0147, test::pad_height + 2e-3);
    for (int k = 0; k < 50; ++k) {
      state.time += 1e-3;
      state.position[0] += 1e-7;
      const GatedForce out = servo.tick(state);
      if (k > 1) CHECK(out.status.ok());
      CHECK(out.force().norm() < 1e-9);
    }
  }
}
