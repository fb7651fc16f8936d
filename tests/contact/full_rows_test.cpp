// More points than rows: which are kept, the effect of friction, and that nothing is written outside the rows.
#include "contact/tool_session.hpp"

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;
using test::AnalyticTissue;
using test::round_tool;
using test::ToolSession;

namespace {

constexpr int row_count = 8;
/// A session with few rows.
struct Crowd : ToolSession {
  Crowd(AnalyticTissue& t, const std::vector<ContactTool>& start, ContactParameters parameters = {})
      : ToolSession(t, start, few(parameters)) {}
  static ContactParameters few(ContactParameters parameters) {
    parameters.capacity = row_count;
    return parameters;
  }
};

constexpr double spring = 1e-2;  // [m/N]

/// Sum of the contact forces along z.
double pressed(const Crowd& s) {
  double sum = 0.0;
  for (const Contact& c : s.problem.contacts()) sum += c.total()[2];
  return sum;
}

}  // namespace

TEST_CASE("full rows: a point that loses its row to a grasp also loses its force", "[contact][rows][grasp][extreme]") {
  // Four columns of four points, 0.4 mm apart; a capsule along them presses two columns: as many points as rows.
  AnalyticTissue tissue(3, 1.2e-3, spring);
  const double radius = 10e-3, height = radius - 4e-6, away = 0.2e-3;
  ContactTool capsule = round_tool(radius, {-0.4e-3, 0.0, radius + 1e-4}, 0.0, 2e-3, Vector3::UnitY());
  ContactTool other = round_tool(radius, {0.0, 0.0, 0.5}, 0.0);
  other.active = false;
  Crowd s(tissue, {capsule, other});
  s.move(0, {-0.4e-3, 0.0, height}, 20);
  REQUIRE(s.problem.contacts().size() == row_count);
  CHECK(s.status.ok());
  s.tools[0].grasping = true;  // three rows for the grasped point, five for the other seven
  s.tick(0, s.tools[0].target);
  REQUIRE(s.problem.is_holding(0));
  CHECK(s.status.has(StatusFlag::degraded_model));
  CHECK(s.problem.contacts().size() == row_count);
  s.move(0, {0.4e-3, 0.0, height}, 40);  // to the two columns that have not been pressed yet
  s.tools[0].grasping = false;
  s.settle(2);
  s.tools[1].active = true;  // rebuilds the list of points near the tools
  s.settle(2);
  const double distance = std::hypot(height, away);
  const double exact = row_count * (radius - distance) / spring * height / distance;
  CHECK(s.problem.contacts().size() == row_count);
  CHECK_THAT(s.force()[2], WithinRel(exact, 1e-5));
  CHECK_THAT(pressed(s), WithinRel(exact, 1e-5));
  CHECK(s.force(1) == Vector3::Zero());
  CHECK((s.tools[0].proxy - s.tools[0].target).norm() <= 1e-12);
}

TEST_CASE("full rows: they go to points spread over the contact, and the solution for them is exact",
          "[contact][rows][extreme][D4]") {
  AnalyticTissue tissue(60, 0.02, spring);  // a third of a millimetre apart
  const double radius = 4e-3;
  Crowd s(tissue, {round_tool(radius, {5e-5, 2e-5, radius + 1e-4}, 0.0)});
  s.move(0, {5e-5, 2e-5, radius - 1e-3}, 25);
  s.settle();
  CHECK(s.status == Status(StatusFlag::degraded_model));
  CHECK(s.problem.contacts().size() >= row_count / 2);
  CHECK(s.problem.missing_depth() > 0.1);
  CHECK(s.problem.missing_depth() <= 1.0);
  Vector3 sum = Vector3::Zero();
  double farthest = 0.0;
  for (const Contact& c : s.problem.contacts()) {
    const Vector3 path = s.tools[0].proxy - c.rest;
    CHECK_THAT(c.force, WithinRel((radius - path.norm()) / spring, 1e-6));  // independent springs
    sum += c.rest;
    farthest = std::max(farthest, c.rest.head<2>().norm());
  }
  CHECK(sum.head<2>().norm() / row_count < 1e-3);
  CHECK(farthest > 1.2e-3);  // the contact has a radius of 2.6 mm
}

TEST_CASE("full rows: friction acts on the points that press", "[contact][rows][friction][D4]") {
  AnalyticTissue tissue(60, 0.02, spring);
  const double radius = 4e-3, mu = 0.3;
  ContactParameters rough;
  rough.friction = mu;
  Crowd s(tissue, {round_tool(radius, {0.0, 0.0, radius + 1e-4}, 1e-3)}, rough);
  s.move(0, {0.0, 0.0, radius - 4e-4}, 25);
  s.settle(5);
  CHECK(s.problem.contacts().size() == row_count);
  CHECK(s.force().head<2>().norm() < 0.02 * s.force()[2]);
  double least = infinity, most = 0.0;
  s.status = {};
  for (int k = 1; k <= 200; ++k) {
    s.tick(0, {2e-6 * k, 0.0, radius - 4e-4});
    double pressing = 0.0, drag = 0.0;
    for (const Contact& c : s.problem.contacts()) {
      pressing += c.force;
      drag -= c.friction[0];
    }
    if (k <= 100) continue;
    least = std::min(least, drag / pressing);
    most = std::max(most, drag / pressing);
  }
  CHECK(s.status == Status(StatusFlag::degraded_model));
  INFO("friction force over press: " << least << " to " << most);
  CHECK(least > 0.7 * mu);
  CHECK(most <= mu * (1.0 + 1e-9));
}
