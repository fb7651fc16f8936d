// Contact continues when the surface gets other triangles, as by a cut.
#include <palpate/concepts/tissue_adaptor.hpp>

#include "contact/tool_session.hpp"

#include "catch.hpp"

using namespace palpate;

namespace {

/// Springs under a surface whose triangles change: vertices keep their numbers.
class ChangingTissue : public TissueAdaptor<test::AnalyticTissue> {
 public:
  ChangingTissue() : TissueAdaptor(springs_), surface_(springs_.contact_surface()) {}

  const ContactSurface& contact_surface() const noexcept { return surface_; }
  std::uint64_t compliance_revision() const noexcept { return revision_; }

  /// Reverses the order of the triangles, rotates their vertices, adds a vertex, and removes the triangles whose centre
  /// satisfies `leaves`.
  template <class Leaves>
  void change(Leaves&& leaves) {
    std::vector<Vector3> positions = surface_.positions();
    std::vector<Triangle> triangles;
    for (const Triangle& t : surface_.triangles()) {
      Vector3 middle = Vector3::Zero();
      for (const int v : t) middle += surface_.position(v) / 3.0;
      if (!leaves(middle)) triangles.push_back({t[1], t[2], t[0]});
    }
    std::ranges::reverse(triangles);
    positions.emplace_back(0.0, 0.0, -0.01);
    surface_ = ContactSurface(std::move(positions), std::move(triangles));
    ++revision_;
  }

 private:
  test::AnalyticTissue springs_{16, 0.04, 5e-3, 1e-3};
  ContactSurface surface_;
  std::uint64_t revision_ = 0;
};
static_assert(TissueModel<ChangingTissue>);

/// A sphere with friction over many contact points.
struct OverTriangles {
  static constexpr double radius = 6e-3;
  explicit OverTriangles(double friction = 0.4)
      : parameters{.maximum_iterations = 20, .force_tolerance = 1e-9, .friction = friction} {}
  ContactParameters parameters;
  ChangingTissue tissue;
  ContactProblem problem{tissue.contact_surface(), 3e-3, parameters};
  std::array<ContactTool, 1> tools{test::round_tool(radius, {0.0, 0.0, radius + 1e-4}, 1e-3)};
  Status status;

  void tick(const Vector3& target) {
    tools[0].motion = target - tools[0].target;
    tools[0].target = target;
    status |= problem.solve(tissue, tools);
  }
  template <class Leaves>
  void change(Leaves&& leaves) {
    tissue.change(leaves);
    ContactProblem fresh(tissue.contact_surface(), 3e-3, parameters);
    problem.move_to(fresh, tissue.contact_surface());
  }
};

Vector3 dragged(int k) {
  return {k < 40 ? 0.0 : 2e-5 * (k - 40), 1e-5 * std::max(0, k - 60), OverTriangles::radius - 1e-5 * std::min(k, 60)};
}

}  // namespace

TEST_CASE("with the same triangles in another order contact and friction continue unchanged", "[contact][surface]") {
  const double friction = GENERATE(0.0, 0.4);
  OverTriangles still(friction), changed(friction);
  double worst = 0.0, longest = 0.0, drag = 0.0;
  for (int k = 0; k < 160; ++k) {
    if (k % 25 == 20) changed.change([](const Vector3&) { return false; });
    still.tick(dragged(k));
    changed.tick(dragged(k));
    worst = std::max(worst, (still.tools[0].force - changed.tools[0].force).norm());
    longest = std::max(longest, still.tools[0].force.norm());
    drag = std::max(drag, still.tools[0].force.head<2>().norm());
  }
  CHECK(longest > 0.05);
  // Sliding friction is solved row by row, so the order of rows affects it slightly; lost friction would be all of it.
  if (friction > 0.0) CHECK(drag > 0.2 * longest);
  CHECK(worst <= (friction > 0.0 ? 0.1 * drag : 1e-7 * longest));
  CHECK(still.status.ok() == changed.status.ok());
}

TEST_CASE("contacts on removed triangles lose their force; the others continue", "[contact][surface][F3]") {
  OverTriangles s;
  for (int k = 0; k < 80; ++k) s.tick(dragged(k));
  const Vector3 before = s.tools[0].force;
  s.change([](const Vector3& x) { return x[0] > 0.02 * 0.2; });  // a part of the dent, and all on that side of it
  s.tick(dragged(80));
  CHECK(s.tools[0].force.allFinite());
  CHECK(s.tools[0].force.norm() > 0.2 * before.norm());
  s.change([](const Vector3&) { return true; });
  s.tick(dragged(81));
  CHECK(s.tools[0].force.norm() == 0.0);  // no triangle is left
  CHECK(s.problem.vertex_forces().empty());
}

TEST_CASE("a grasped point stays grasped, and is released when it is removed", "[contact][surface][grasp]") {
  OverTriangles still, changed;
  for (OverTriangles* s : {&still, &changed}) {
    s->tick({0, 0, OverTriangles::radius - 1e-4});
    s->tools[0].grasping = true;
    for (int k = 0; k < 20; ++k) s->tick({0, 0, OverTriangles::radius + 5e-5 * k});
    REQUIRE(s->problem.is_holding(0));
    REQUIRE(s->tools[0].force[2] < -1e-3);  // it pulls
  }
  changed.change([](const Vector3&) { return false; });
  for (int k = 20; k < 40; ++k)
    for (OverTriangles* s : {&still, &changed}) s->tick({1e-5 * k, 0, OverTriangles::radius + 5e-5 * k});
  CHECK(changed.problem.is_holding(0));
  CHECK((still.tools[0].force - changed.tools[0].force).norm() <= 1e-9 * still.tools[0].force.norm());
  changed.change([](const Vector3& x) { return x.norm() < 8e-3; });
  changed.tick({0, 0, OverTriangles::radius + 2e-3});
  CHECK(!changed.problem.is_holding(0));
  CHECK(changed.tools[0].force.norm() == 0.0);
}
