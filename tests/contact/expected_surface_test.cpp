// The search for contacts on a surface that moves by itself: around where its tissue expects it to be.
#include "contact/tool_session.hpp"

#include <algorithm>

#include "catch.hpp"

using namespace palpate;
using test::AnalyticTissue;
using test::round_tool;

namespace {

constexpr double sphere_radius = 4e-3;

/// Springs whose resting surface rises and sinks from update to update. It may state where known forces hold it.
class UpdatedSprings : public AnalyticTissue {
 public:
  explicit UpdatedSprings(bool expects)
      : AnalyticTissue(40, 0.04, 1e-2, 5e-2), expects_(expects), moving_(AnalyticTissue::contact_surface()) {
    update({}, 0.0);
  }
  const ContactSurface& contact_surface() const noexcept { return moving_; }
  std::uint64_t compliance_revision() const noexcept { return moving_.revision(); }

  void update(std::span<const VertexForce> forces, double height) {
    std::vector<Vector3> positions = AnalyticTissue::contact_surface().positions();
    for (Vector3& x : positions) x[2] += height;
    moving_.move_to(positions);
    Vector3 sum = Vector3::Zero();
    for (const VertexForce& f : forces) {
      sum += f.force.in_model_axes();
      positions[static_cast<std::size_t>(f.vertex)] += own() * f.force.in_model_axes();
    }
    for (Vector3& x : positions) x += common() * sum;
    if (expects_) moving_.expect(positions, forces);
  }

 private:
  bool expects_;
  ContactSurface moving_;
};

ContactParameters to_rounding() {
  ContactParameters p;
  p.force_tolerance = 1e-10;
  p.maximum_iterations = 40;
  return p;
}

/// A sphere, and its contacts with and without expectation.
struct TwoSearches {
  UpdatedSprings expecting{true}, plain{false};
  ContactProblem with{expecting.contact_surface(), sphere_radius, to_rounding()};
  ContactProblem without{plain.contact_surface(), sphere_radius, to_rounding()};
  std::vector<ContactTool> tool{round_tool(sphere_radius, {0.0, 0.0, sphere_radius + 1e-4}, 2e-3)}, same = tool;
  /// Differences of the force in ticks that converged, and in those whose bound of work ended them.
  double worst = 0.0, unsettled = 0.0, largest = 0.0;
  int converged = 0;

  void tick(const Vector3& target) {
    for (auto* t : {&tool, &same}) {
      t->front().motion = target - t->front().target;
      t->front().target = target;
    }
    expecting.compliance_calls = plain.compliance_calls = 0;
    const Status status = with.solve(expecting, tool) | without.solve(plain, same);
    const bool settled = !status.has(StatusFlag::solver_not_converged);
    double& difference = settled ? worst : unsettled;
    difference = std::max(difference, (tool[0].force - same[0].force).norm());
    converged += settled;
    largest = std::max(largest, same[0].force.norm());
  }
  void update(std::span<const VertexForce> forces, double height) {
    const std::vector<VertexForce> copy(forces.begin(), forces.end());
    expecting.update(copy, height);
    plain.update(copy, height);
  }
  double depth() const { return plain.common() * same[0].force.norm() / sphere_radius; }
};

}  // namespace

TEST_CASE("a search around the expected surface finds the contacts of one around the resting surface",
          "[contact][candidates]") {
  TwoSearches s;
  double deepest = 0.0;
  for (int t = 0; t < 1200; ++t) {
    const double height = 2e-4 * std::sin(0.02 * t);
    if (t % 16 == 0) s.update(s.without.vertex_forces(), height);
    const double down = 0.5 * (1.0 - std::cos(0.02 * t));
    s.tick({8e-3 * std::sin(0.007 * t), 6e-3 * std::sin(0.011 * t), sphere_radius * (1.02 - 3.0 * down)});
    deepest = std::max(deepest, s.depth());
  }
  INFO("largest force " << s.largest << " N, largest difference " << s.worst << " N, " << deepest << " radii deep");
  CHECK(deepest > 1.0);
  CHECK(s.converged > 700);
  CHECK(s.worst <= 1e-7 * s.largest);
  CHECK(s.unsettled <= 1e-2 * s.largest);
}

TEST_CASE("where other forces act than those expected, the search is as wide as without expectation",
          "[contact][candidates]") {
  TwoSearches s;
  const auto press = [&](double x, double height, int ticks) {
    for (int t = 1; t <= ticks; ++t) s.tick({x, 0.0, sphere_radius * (1.02 - 2.5 * t / ticks) + height});
  };
  press(0.0, 0.0, 60);
  const std::vector<VertexForce> pressed(s.without.vertex_forces().begin(), s.without.vertex_forces().end());
  REQUIRE(s.depth() > 1.0);
  SECTION("the tool has left") {
    for (int t = 0; t < 30; ++t) s.tick({0.0, 0.0, sphere_radius * (-1.48 + 0.2 * t)});
    REQUIRE(s.same[0].force.norm() == 0.0);
    s.update(pressed, 1e-4);
    press(0.01, 1e-4, 40);
  }
  SECTION("the tool presses and was expected not to") {
    s.update({}, 1e-4);
    for (int t = 0; t < 20; ++t) s.tick({2e-4 * t, 0.0, -1.48 * sphere_radius});
  }
  SECTION("a leap of the surface") {
    s.update(pressed, 0.5 * sphere_radius);
    for (int t = 0; t < 20; ++t) s.tick({-2e-4 * t, 0.0, -1.48 * sphere_radius});
  }
  INFO("largest force " << s.largest << " N, largest difference " << s.worst << " N");
  CHECK(s.same[0].force.norm() > 0.0);
  CHECK(s.converged > 60);
  CHECK(s.worst <= 1e-7 * s.largest);
  CHECK(s.unsettled <= 1e-2 * s.largest);
}

TEST_CASE("on an expected surface the first tick after an update has little more work than the others",
          "[contact][candidates]") {
  TwoSearches s;
  std::vector<long> first, first_without;
  for (int t = 0; t < 800; ++t) {
    if (t % 16 == 0) s.update(s.without.vertex_forces(), 1e-5 * std::sin(0.1 * t));
    s.tick({1e-5 * t, 0.0, std::max(-1.5, 1.0 - 0.02 * t) * sphere_radius});
    if (t % 16 != 0 || t < 200) continue;
    first.push_back(s.expecting.compliance_calls);
    first_without.push_back(s.plain.compliance_calls);
  }
  std::sort(first.begin(), first.end());
  std::sort(first_without.begin(), first_without.end());
  INFO("largest number of calls of compliance " << first.back() << ", without expectation " << first_without.back());
  CHECK(s.depth() > 1.0);
  CHECK(2 * first.back() < first_without.front());
}
