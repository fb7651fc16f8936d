// The list of contact points near the tools: it misses none, and no tick has the work of a whole search.
#include "contact/tool_session.hpp"

#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

using namespace palpate;
using test::AnalyticTissue;
using test::round_tool;
using test::ToolSession;

namespace {

constexpr double tool_radius = 4e-3;

ContactParameters tight() {
  ContactParameters p;
  p.force_tolerance = 1e-9;
  p.maximum_iterations = 30;
  return p;
}

/// A sphere above the middle, and a tool far away that is lifted or set down to make the next tick search again.
std::vector<ContactTool> sphere_and_switch(const Vector3& at) {
  return {round_tool(tool_radius, at, 2e-3), round_tool(tool_radius, {0.0, 0.0, 1.0}, 2e-3)};
}

}  // namespace

TEST_CASE("a list that is kept or built in parts has the forces of one that is built in every tick",
          "[contact][candidates]") {
  testing::Random random(11);
  AnalyticTissue tissue(60, 0.06, 1e-2, 1e-3), same(60, 0.06, 1e-2, 1e-3);  // 1 mm apart
  const Vector3 start(0.0, 0.0, tool_radius + 1e-4);
  ToolSession kept(tissue, sphere_and_switch(start), tight(), tool_radius);
  ToolSession rebuilt(same, sphere_and_switch(start), tight(), tool_radius);
  Vector3 at = start, velocity = Vector3::Zero();
  double worst = 0.0, largest = 0.0;
  for (int t = 0; t < 3000; ++t) {
    // Speeds of 0.001 to 0.3 radii per tick, so that lists end in all ways: unused, in the middle, by one move.
    if (t % 40 == 0) {
      const double angle = random.uniform(0.0, 6.28), speed = tool_radius * std::pow(10.0, random.uniform(-3.0, -0.5));
      velocity = speed * Vector3(std::cos(angle), std::sin(angle), 0.0);
    }
    for (int k = 0; k < 2; ++k)
      if (std::abs(at[k] + velocity[k]) > 0.02) velocity[k] = -velocity[k];
    at += velocity;
    at[2] = tool_radius - 1e-3 * (1.0 + std::sin(0.01 * t));
    rebuilt.tools[1].active = t % 2 == 0;
    kept.tick(0, at);
    rebuilt.tick(0, at);
    worst = std::max(worst, (kept.force() - rebuilt.force()).norm());
    largest = std::max(largest, rebuilt.force().norm());
  }
  INFO("largest force " << largest << ", largest difference " << worst);
  CHECK(largest > 0.0);
  CHECK(worst <= 1e-6 * largest);
}

TEST_CASE("no tick of a steady motion has the work of a whole search", "[contact][candidates]") {
  AnalyticTissue tissue(60, 0.06, 1e-2, 1e-3);
  ToolSession s(tissue, {round_tool(tool_radius, {-0.015, 2e-4, tool_radius + 1e-4}, 2e-3)}, {}, tool_radius);
  s.move(0, {-0.015, 2e-4, tool_radius - 5e-4}, 40);
  std::vector<long> calls;
  for (int t = 0; t < 600; ++t) {
    tissue.compliance_calls = 0;
    s.tick(0, s.tools[0].target + Vector3(5e-5, 0.0, 0.0));
    calls.push_back(tissue.compliance_calls);
  }
  std::sort(calls.begin(), calls.end());
  INFO("calls of compliance in a tick: median " << calls[300] << ", largest " << calls.back());
  CHECK(calls.back() <= 4 * calls[300]);
}
