// Capsules, their torque, and grasped points compared with closed forms.
#include "contact/tool_session.hpp"

#include <palpate/contact/tools.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using test::AnalyticTissue;
using test::round_tool;
using test::ToolSession;

namespace {

struct Wrench {
  Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
};

/// Independent springs: every vertex within the capsule pushes it from its position towards the axis.
Wrench wrench_of_springs(const AnalyticTissue& tissue, const Vector3& middle, const Vector3& axis, double half,
                         double radius) {
  Wrench w;
  for (const Vector3& x : tissue.contact_surface().positions()) {
    const Vector3 arm = std::clamp(axis.dot(x - middle), -half, half) * axis;
    const Vector3 offset = middle + arm - x;
    const double depth = radius - offset.norm();
    if (depth <= 0.0) continue;
    const Vector3 f = depth / tissue.own() * offset.normalized();
    w.force += f;
    w.torque += arm.cross(f);
  }
  return w;
}

}  // namespace

TEST_CASE("a capsule on springs: force and torque equal the closed form in any orientation", "[contact][capsule]") {
  testing::Random random(81);
  const double radius = 3e-3, half = 6e-3;
  double worst = 0.0, worst_torque = 0.0;
  std::size_t most = 0;
  for (int run = 0; run < 40; ++run) {
    AnalyticTissue tissue(20, 0.03, 2e-2);  // 1.5 mm apart
    const double angle = random.uniform(0.0, 6.28);
    // No end is deeper than half the radius: independent springs are not pushed aside, so that the cone would act.
    const double depth = random.uniform(2e-4, 1e-3), steepest = std::min(0.15, (0.5 * radius - depth) / half);
    const Vector3 axis(std::cos(angle), std::sin(angle), random.uniform(-steepest, steepest));
    const Vector3 end(random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), radius - depth);
    ToolSession s(tissue, {round_tool(radius, end + Vector3(0, 0, 3e-3), 0.0, half, axis)});
    s.move(0, end, 100);
    s.settle();
    const Wrench exact = wrench_of_springs(tissue, end, axis.normalized(), half, radius);
    worst = std::max(worst, (s.force() - exact.force).norm() / exact.force.norm());
    worst_torque = std::max(worst_torque, (s.tools[0].torque - exact.torque).norm() / (half * exact.force.norm()));
    most = std::max(most, s.problem.contacts().size());
    CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
  }
  INFO("error of force " << worst << ", of torque " << worst_torque << ", up to " << most << " contacts");
  CHECK(worst <= 1e-4);
  CHECK(worst_torque <= 1e-4);
  CHECK(most >= 16);
}

TEST_CASE("a capsule that rotates over springs", "[contact][capsule]") {
  const double radius = 3e-3, half = 6e-3;
  AnalyticTissue tissue(20, 0.03, 2e-2);
  ToolSession s(tissue, {round_tool(radius, {3e-4, 2e-4, 3.1e-3}, 0.0, half)});
  s.move(0, {3e-4, 2e-4, 2.3e-3}, 100);
  double worst = 0.0;
  for (int k = 1; k <= 500; ++k) {  // half a rotation about the vertical, with a changing tilt
    const Matrix3 turn = rotation_by(Vector3(0, 0, 0.0063 * k)) * rotation_by(Vector3(0, 0.05 * std::sin(0.05 * k), 0));
    s.tick(0, s.tools[0].target, turn);
    const Wrench exact = wrench_of_springs(tissue, s.tools[0].target, turn * Vector3::UnitX(), half, radius);
    worst = std::max(worst, (s.force() - exact.force).norm() / exact.force.norm());
    worst = std::max(worst, (s.tools[0].torque - exact.torque).norm() / (half * exact.force.norm()));
  }
  INFO("worst " << worst);
  CHECK(worst <= 5e-3);
  CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
}

TEST_CASE("the coupling for rotations is a spring in series", "[contact][capsule][torque]") {
  // Two vertices under the ends of a long capsule; a rotation about y lowers one end.
  const double radius = 0.02, half = 0.06, a = 0.05, own = 1e-3, coupling = 5e-4, rotational = 0.4, depth = 1e-3,
               tilt = 2e-3;
  AnalyticTissue tissue(2, 2.0 * a, own);  // at -a, 0, a
  ContactTool tool = round_tool(radius, {0, 0, radius + 1e-3}, coupling, half);
  tool.rotational_compliance = rotational;
  ToolSession s(tissue, {tool});
  s.move(0, {0, 0, radius - depth}, 100);
  CHECK(s.tools[0].torque.norm() <= 1e-9);
  for (int k = 1; k <= 20; ++k) s.tick(0, s.tools[0].target, rotation_by(Vector3(0, 0.05 * k * tilt, 0)));
  s.settle();
  // Ends move down by depth +- a theta, the middle by depth: three springs of 1/own.
  const double force = 3.0 * depth / (own + 3.0 * coupling);
  const double stiffness = 2.0 * a * a / own;  // [N m/rad] of the two ends
  const double torque = -tilt * stiffness / (1.0 + rotational * stiffness);
  CHECK_THAT(s.force()[2], WithinRel(force, 2e-3));
  CHECK_THAT(s.tools[0].torque[1], WithinRel(torque, 2e-3));
  // Rendered: the torque is the rotational stiffness times the angle between device and proxy.
  const Eigen::AngleAxisd lag(Matrix3(s.tools[0].rotation * s.tools[0].target_rotation.transpose()));
  CHECK((lag.angle() * lag.axis() - rotational * s.tools[0].torque).norm() <= 1e-6 * tilt);
}

TEST_CASE("a capsule of zero length is bitwise equal to a sphere", "[contact][capsule]") {
  AnalyticTissue tissue(20, 0.02, 2e-2, 1e-3);
  ToolSession sphere(tissue, {round_tool(4e-3, {0, 0, 4.1e-3}, 1e-3)}),
      capsule(tissue, {round_tool(4e-3, {0, 0, 4.1e-3}, 1e-3, 0.0, {1, 2, 3})});
  for (int k = 0; k < 200; ++k) {
    const Vector3 to(1e-5 * k, 3e-6 * k, 4.1e-3 - 4e-6 * k);
    sphere.tick(0, to);
    capsule.tick(0, to, rotation_by(Vector3(0.01 * k, 0, 0)));
    REQUIRE(sphere.force() == capsule.force());
  }
  CHECK(sphere.force()[2] > 0.0);
}

TEST_CASE("invalid capsules are refused", "[contact][capsule]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const CapsuleTool& bad : {CapsuleTool(0.0, 0.0), CapsuleTool(nan, 0.0), CapsuleTool(1e-3, -1e-3),
                                 CapsuleTool(1e-3, nan), CapsuleTool(1e-3, 0.017),
                                 CapsuleTool(1e-3, 1e-2, Vector3::Zero()), CapsuleTool(1e-3, 1e-2, Vector3(nan, 0, 0))})
    CHECK_THROWS_AS(bad.require_valid(), SetupError);
  CHECK_NOTHROW(CapsuleTool(1e-3, 0.016, Vector3(0, 0, 5)).require_valid());
}

TEST_CASE("a grasped point is bilateral: pull, push and lateral motion act on one spring", "[contact][grasp]") {
  const double own = 1e-3, common = 5e-4, coupling = 2e-3, soft = own + common + coupling, radius = 4e-3;
  AnalyticTissue tissue(4, 0.2, own, common);
  ToolSession s(tissue, {round_tool(radius, {0, 0, radius + 1e-4}, coupling)});
  s.tick();
  CHECK_FALSE(s.problem.is_holding(0));
  s.tools[0].grasping = true;  // a gap of a tenth of a millimetre: near enough
  s.tick();
  REQUIRE(s.problem.is_holding(0));
  const Vector3 grasped_at = s.tools[0].target;
  for (const Vector3& by :
       {Vector3(0, 0, 2e-3), Vector3(1e-3, -2e-3, 3e-3), Vector3(0, 0, -1e-3), Vector3(-3e-3, 0, 0)}) {
    s.move(0, grasped_at + by, 40);
    CHECK((s.force() + by / soft).norm() <= 1e-5 * by.norm() / soft);
    CHECK_THAT((s.tools[0].proxy - grasped_at - by * (own + common) / soft).norm(), WithinAbs(0.0, 1e-8));
  }
  s.move(0, grasped_at + Vector3(0, 0, 2e-3), 40);
  s.tools[0].grasping = false;
  s.tick();
  CHECK_FALSE(s.problem.is_holding(0));
  CHECK(s.force() == Vector3::Zero());
  s.tools[0].grasping = true;  // no point within reach any more
  s.tick();
  CHECK_FALSE(s.problem.is_holding(0));
  s.move(0, grasped_at, 40);  // a tool that is already grasping does not grasp points that it reaches later
  CHECK_FALSE(s.problem.is_holding(0));
}

TEST_CASE("one tool pulls a fold while another presses next to it", "[contact][grasp]") {
  const double own = 1e-3, common = 5e-4, radius = 4e-3;
  AnalyticTissue tissue(4, 0.2, own, common);  // vertices at -0.05, 0, 0.05
  ToolSession s(tissue,
                {round_tool(radius, {-0.05, 0, radius}, 0.0), round_tool(radius, {0.05, 0, radius + 1e-4}, 0.0)});
  s.tools[0].grasping = true;
  s.tick();
  REQUIRE(s.problem.is_holding(0));
  const double lift = 1e-3, depth = 5e-4;
  s.move(0, {-0.05, 0, radius + lift}, 40);
  s.move(1, {0.05, 0, radius - depth}, 40);
  s.settle(5);
  // own f + common (f + g) = -lift, own g + common (f + g) = depth
  const double f = (-lift - common * (depth - lift) / (own + 2.0 * common)) / own,
               g = (depth - common * (depth - lift) / (own + 2.0 * common)) / own;
  CHECK_THAT(s.force(0)[2], WithinRel(f, 1e-4));
  CHECK_THAT(s.force(1)[2], WithinRel(g, 1e-4));
}

TEST_CASE("a capsule that grasps with its end carries a torque", "[contact][grasp][torque]") {
  AnalyticTissue tissue(4, 0.2, 1e-3);
  const double radius = 4e-3, half = 0.02;
  ToolSession s(tissue, {round_tool(radius, {0, 0, radius + half}, 0.0, half, Vector3::UnitZ())});
  s.tools[0].grasping = true;
  s.tick();
  REQUIRE(s.problem.is_holding(0));
  s.move(0, {1e-3, 0, radius + half}, 20);
  CHECK_THAT(s.force()[0], WithinRel(-1.0, 1e-5));
  CHECK_THAT(s.tools[0].torque[1], WithinRel(radius + half, 1e-5));  // (0, 0, -(r + h)) x (-1, 0, 0) N
}

TEST_CASE("a capsule that presses with its side has the cap and cone of a sphere all along its axis",
          "[contact][capsule]") {
  testing::Random random(83);
  const double radius = 3e-3, half = 6e-3;
  int on_cone = 0;
  for (int k = 0; k < 200; ++k) {
    ContactTool capsule = round_tool(radius, Vector3(1e-3, -2e-3, 3e-3), 0.0), sphere = capsule;
    capsule.half_length = half;
    capsule.rotation = rotation_by(random.vector<3>(-2.0, 2.0));
    const Vector3 across = capsule.axis().unitOrthogonal();
    // A tool that rotates in a tick may be steeper than any that gets a cone.
    const Vector3 outward = (across + random.uniform(-2.0, 2.0) * capsule.axis()).normalized();
    capsule.outward = sphere.outward = outward;
    capsule.entered = sphere.entered = 1.0;
    const Vector3 p = capsule.proxy + random.vector<3>(-12e-3, 12e-3);
    const detail::CorePoint found = capsule.closest(p);
    double least = 1.0;
    for (int i = -2000; i <= 2000; ++i) {
      sphere.proxy = capsule.proxy + half * i / 2000.0 * capsule.axis();
      least = std::min(least, sphere.closest(p).distance);
    }
    CHECK(found.distance <= least + 1e-12);
    CHECK_THAT(found.distance, WithinAbs(least, 1e-3 * radius));
    CHECK_THAT(found.normal.norm(), WithinAbs(1.0, 1e-12));
    CHECK(found.normal.dot(outward) >= 0.5 - 1e-9);
    on_cone += found.normal.dot(outward) < 0.5 + 1e-9;
  }
  CHECK(on_cone > 30);
}
