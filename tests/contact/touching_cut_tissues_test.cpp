// Tissues that touch each other and are cut: as if they had been cut before, on all threads, and back.
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "contact/touching_organs.hpp"
#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

using namespace palpate;

namespace touching_cut_tissues_test {

using namespace touching_test;

namespace {

using Cut = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
using Uncut = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
struct CutMoving : HapticFEModel<Smoothed<Tet4>, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>> {
  CutMoving(const Mesh<Tet4>& mesh, const Scene& scene, const NeoHookean& material)
      : HapticFEModel(mesh, scene, material, {}, {.inertia = false}) {}
};

/// Beside the middle of the sheet, through all of it.
template <class Tissue>
CutOrder notch(const Tissue& tissue) {
  return {
      .remove = elements_within(
          tissue.body().mesh,
          where::box({0.55 * side, 0.2 * side, -1e-3}, {0.8 * side, 0.8 * side, 6e-3}).relative_to(tissue.origin())),
      .open = {}};
}
/// The faces across the middle: a blade would cut others where the tissue is displaced.
template <class Tissue>
CutOrder slit_faces(Tissue& tissue) {
  CutOrder order;
  tissue.read([&](const auto& topology, const auto&...) {
    const auto& mesh = topology.mesh();
    const auto middle = [&](Index e) {
      Vector3 sum = Vector3::Zero();
      for (int a = 0; a < Tet4::nodes; ++a) sum += mesh.position(Index{mesh.element_node(e, a)});
      return Vector3(0.25 * sum + tissue.origin());
    };
    for (Index e = 0; e < mesh.element_count(); ++e)
      for (std::size_t f = 0; f < Tet4::faces.size(); ++f) {
        const Index other = topology.neighbour(e, f);
        const Vector3 m = middle(e);
        if (other >= 0 && m[0] < 0.41 * side && middle(other)[0] >= 0.41 * side &&
            std::abs(m[1] - 0.5 * side) < 0.25 * side)
          order.open.push_back({e, static_cast<int>(f)});
      }
  });
  return order;
}
/// From side to side across the middle.
BladeSweep slit() {
  return {{0.41 * side, 0.25 * side, 6e-3},
          {0.41 * side, 0.75 * side, 6e-3},
          {0.41 * side, 0.25 * side, -1e-3},
          {0.41 * side, 0.75 * side, -1e-3}};
}
template <class Tissue>
void cut_twice(Tissue& tissue) {
  tissue.cut(notch(tissue));
  tissue.cut(slit_faces(tissue));
}
/// Cuts, and the checks that follow.
template <class Worked>
void finish(Worked& worked) {
  for (int i = 0; i < 30; ++i) worked.background_work();
}

/// Force of a sphere pressed by 2 mm; `cut` is called between the ticks 100 and 101.
template <class Cutting>
double press_and_cut(TouchingTissues& tissues, Cutting cut) {
  Beside beside{tissues};
  return press(tissues.group(), 2e-3, [&](int t) {
    if (t == 100) cut();
    beside(t);
  });
}

/// Force of a press on a tissue that is cut before it touches, of one that is cut meanwhile, and of one that is not.
template <class Below, class Above>
std::array<double, 3> forces_of_cuts(int cells) {
  std::array<double, 3> force{};
  for (std::size_t when = 0; when < 3; ++when) {
    Stack<Below, Above> stack(cells, 1);
    if (when == 0) {
      cut_twice(stack.above);
      finish(stack.above);
    }
    TouchingTissues tissues(stack.below, stack.above);
    force[when] = press_and_cut(tissues, [&] {
      if (when == 1) cut_twice(stack.above);
    });
  }
  return force;
}

}  // namespace

TEST_CASE("a tissue that is cut touches others as if it had been cut before", "[contact][touching][cut]") {
  const auto [before, meanwhile, never] = forces_of_cuts<Static, Cut>(5);
  INFO(before << " " << meanwhile << " " << never);
  CHECK(std::abs(meanwhile - before) < 1e-3 * before);
  CHECK(before < 0.9 * never);
}

TEST_CASE("a moving tissue that is cut touches others as if it had been cut before", "[contact][touching][cut]") {
  const auto [before, meanwhile, never] = forces_of_cuts<Static, CutMoving>(4);
  INFO(before << " " << meanwhile << " " << never);
  CHECK(std::abs(meanwhile - before) < 0.05 * before);  // contact points are placed on the surface as pressed then
  CHECK(before < 0.95 * never);
}

TEST_CASE("a tissue that can be cut touches others like one that cannot, until it is", "[contact][touching][cut]") {
  std::array<double, 2> force{};
  {
    Stack<Uncut, Uncut> stack(5, 1);
    TouchingTissues tissues(stack.below, stack.above);
    force[0] = press(tissues.group(), 2e-3, Beside{tissues});
  }
  Stack<Cut, Cut> stack(5, 1);
  TouchingTissues tissues(stack.below, stack.above);
  force[1] = press(tissues.group(), 2e-3, Beside{tissues});
  CHECK(std::abs(force[1] - force[0]) < 1e-4 * force[0]);
}

TEST_CASE("a reset restores tissues that touch and were cut", "[contact][touching][cut]") {
  Stack<Static, Cut> stack(4, 1);
  TouchingTissues tissues(stack.below, stack.above);
  const double whole = press(tissues.group(), 2e-3, Beside{tissues});
  const double slit = press_and_cut(tissues, [&] { cut_twice(stack.above); });
  CHECK(slit < 0.95 * whole);
  CHECK(stack.above.newest_surface().vertex_count() > static_cast<int>(stack.above.touchable_nodes().size()));
  stack.above.reset();
  tissues.reset();
  CHECK(std::abs(press(tissues.group(), 2e-3, Beside{tissues}) - whole) < 1e-3 * whole);
}

TEST_CASE("ticks at touching tissues report a cut from its order on until they feel it", "[contact][touching][cut]") {
  Stack<Static, Cut> stack(4, 1);
  TouchingTissues tissues(stack.below, stack.above);
  HapticServo servo(tissues.group(), SphereTool{4e-3}, open_options());
  ToolState state;
  state.position = {0.5 * side, 0.5 * side, 8.5e-3};
  const auto tick = [&] {
    state.time += 1e-3;
    servo.tick(state);
    return servo.tick_view().tissue_status(1).has(StatusFlag::degraded_model);
  };
  for (int i = 0; i < 20; ++i) tissues.background_work();
  CHECK_FALSE(tick());
  const int vertices = tissues.tissue(1).contact_surface().vertex_count();
  stack.above.cut(slit());
  CHECK(tick());
  CHECK(tissues.tissue(1).contact_surface().vertex_count() == vertices);
  finish(tissues);
  CHECK_FALSE(tick());
  CHECK(tissues.tissue(1).contact_surface().vertex_count() > vertices);
  // Nobody makes cuts.
  stack.above.cut(notch(stack.above));
  Status status;
  for (int i = 0; i < 600; ++i) {
    tick();
    status = servo.tick_view().tissue_status(1);
  }
  CHECK(status.has(StatusFlag::stalled_tissue));
}

namespace {

/// Height by which tools and neighbours lift the middle of the sheet, between its two layers of elements.
template <class Tissue>
double lift_of_middle(Tissue& sheet, const std::vector<VertexForce>& forces) {
  const VectorX u = sheet.displacement(forces);
  const Mesh<Tet4>& mesh = sheet.body().mesh;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if ((mesh.position(i) + sheet.origin() - Vector3(0.5 * side, 0.5 * side, 2.5e-3)).norm() < 1e-6)
      return u[3 * i + 2];
  return 0.0;
}
/// Cuts horizontally through the middle of the sheet, and counts the open faces inside: between its two layers of
/// elements, and others.
template <class Tissue>
std::array<int, 2> faces_of_cut_at(TouchingTissues& tissues, Tissue& sheet, double z) {
  constexpr double from = 0.42 * side, to = 0.58 * side;
  sheet.cut(BladeSweep{{from, from, z}, {from, to, z}, {to, from, z}, {to, to, z}});
  finish(tissues);
  std::array<int, 2> faces{};
  sheet.read([&](const CutTopology<Tet4>& topology, const auto&) {
    for (Index e = 0; e < topology.mesh().element_count(); ++e)
      for (std::size_t f = 0; f < Tet4::faces.size(); ++f) {
        if (topology.neighbour(e, f) >= 0) continue;
        double lowest = infinity, highest = -infinity;
        bool is_inside = true;
        for (const NodeId node : topology.face_nodes({e, static_cast<int>(f)})) {
          const Vector3 x = topology.mesh().position(Index{topology.origin_of(node)}) + sheet.origin();
          lowest = std::min(lowest, x[2]);
          highest = std::max(highest, x[2]);
          is_inside = is_inside && std::abs(x[0] - 0.5 * side) < 0.4 * side && std::abs(x[1] - 0.5 * side) < 0.4 * side;
        }
        if (!is_inside || highest < 1e-6 || lowest > 5e-3 - 1e-6) continue;
        ++faces[highest - lowest < 1e-9 ? 0 : 1];
      }
  });
  return faces;
}

}  // namespace

TEST_CASE("a blade cuts a tissue where its neighbours and tools have moved it", "[contact][touching][cut][blade]") {
  const bool is_pressed = GENERATE(false, true);
  CAPTURE(is_pressed);
  Stack<Static, Cut> stack(6);
  if (!is_pressed) stack.below.set_pose(lowered(-1.5e-3));
  TouchingTissues tissues(stack.below, stack.above);
  TouchingTissue& sheet = tissues.tissue(1);
  std::vector<VertexForce> forces;
  if (is_pressed)
    forces.push_back({nearest_vertex(sheet, {0.5 * side, 0.5 * side, 5e-3}), ModelVector(Vector3(0.0, 0.0, -0.1))});
  for (int i = 0; i < 3; ++i) {
    sheet.begin_tick();
    sheet.end_tick(forces);
    tissues.solve();
  }
  const std::span<const VertexForce> of_others = tissues.contact_forces(1);
  forces.insert(forces.end(), of_others.begin(), of_others.end());
  const double lift = lift_of_middle(stack.above, forces);
  CHECK((is_pressed ? lift < -0.5e-3 : lift > 0.4e-3));
  const auto [between_layers, others] = faces_of_cut_at(tissues, stack.above, 2.5e-3 + lift);
  CHECK(between_layers > 0);
  CHECK(others == 0);
}

TEST_CASE("a cut waits until ticks have the surface of the last solution", "[contact][touching][cut]") {
  Stack<Static, Cut> stack(4, 1);
  TouchingTissues tissues(stack.below, stack.above);
  TouchingTissue& tissue = tissues.tissue(1);
  tissue.begin_tick();
  tissues.solve();
  stack.above.cut(notch(stack.above));
  tissues.background_work();
  CHECK(stack.above.cut_report().cuts == 0);
  tissue.begin_tick();
  for (int i = 0; i < 3; ++i) tissues.background_work();
  CHECK(stack.above.cut_report().cuts == 1);
  // Without ticks it waits for a few calls only.
  stack.above.cut(slit());
  finish(tissues);
  finish(tissues);
  CHECK(stack.above.cut_report().cuts == 2);
}

TEST_CASE("a blade of a session cuts one of the tissues that touch", "[contact][touching][cut][blade]") {
  Stack<Static, Cut> stack(5);
  TouchingTissues tissues(stack.below, stack.above);
  HapticServo servo(tissues.group(), {SphereTool{3e-3}, BladeTool{.edge = {0.0, 0.5 * side, 0.0}, .toughness = 5.0}},
                    open_options());
  Beside beside{tissues};
  std::vector<ToolState> states(2);
  for (int t = 0; t < 300; ++t) {
    for (ToolState& s : states) s.time += 1e-3;
    states[0].position = {0.75 * side, 0.5 * side, 8.0e-3};
    states[1].position = {0.43 * side, 0.5 * side, 7e-3 - 6e-3 * t / 300.0};
    servo.tick(states);
    beside(t);
  }
  CHECK(servo.tick_view().blade(1, 1)->area() > 0.0);
  CHECK(stack.above.cut_report().cuts > 0);
  CHECK(tissues.report().status.ok());
  TissueAdaptor<TouchingTissue> below(tissues.tissue(0)), above(tissues.tissue(1));
  CHECK_FALSE(TissueView(below).can_be_cut());
  CHECK(TissueView(above).can_be_cut());
  Stack<Static, Static> others(3);
  TouchingTissues uncut(others.below, others.above);
  CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(uncut.group(), BladeTool{.edge = {0.0, 0.01, 0.0}}));
  CHECK_REFUSED(SetupErrorKind::unsupported,
                TouchingTissues(TissueContactOptions{.self_contact = true}, others.below, stack.above));
}

TEST_CASE("a piece that is cut off touches nothing", "[contact][touching][cut]") {
  Stack<Static, Cut> stack(4);
  stack.below.set_pose(lowered(-0.4e-3));
  TouchingTissues tissues(stack.below, stack.above);
  const double before = tissues.report().force;
  for (const double x : {0.26 * side, 0.74 * side})  // beside both supports
    stack.above.cut(BladeSweep{{x, -1e-3, -1e-3}, {x, side + 1e-3, -1e-3}, {x, -1e-3, 7e-3}, {x, side + 1e-3, 7e-3}});
  finish(tissues);
  stack.above.read(
      [](const CutTopology<Tet4>& topology, const auto&) { CHECK(topology.detached_fragments().size() == 1); });
  CHECK(tissues.report().force > 0.0);  // of the rest
  CHECK(tissues.report().force < before);
  CHECK_FALSE(tissues.report().status.has(StatusFlag::lost_contact));
  TouchingTissue& tissue = tissues.tissue(1);
  tissue.begin_tick();
  for (const VertexForce& f : tissues.contact_forces(1))
    CHECK_FALSE(tissue.contact_surface().triangles_at(f.vertex).empty());
}

TEST_CASE("what is cut away presses nothing, also where an edge pressed", "[contact][touching][cut]") {
  const auto wedge = [] { return Cut(wedge_mesh(), Scene().fix("z0").touch("surface"), linear(5e3, 0.3)); };
  Cut below = wedge(), above = wedge();
  Eigen::Isometry3d pose(Eigen::Translation3d(0.5 * side / 6.0, 0.5 * side / 6.0, -0.3e-3));
  pose.rotate(Eigen::AngleAxisd(0.5 * 3.14159265358979, Vector3::UnitZ()));
  pose.rotate(Eigen::AngleAxisd(3.14159265358979, Vector3::UnitX()));
  above.set_pose(pose);
  TouchingTissues tissues(below, above);
  CHECK(tissues.report().force > 1e-3);
  below.cut(CutOrder{
      .remove = elements_within(below.body().mesh, where::above({0.0, 0.0, -5e-3}).relative_to(below.origin())),
      .open = {}});
  finish(tissues);
  tissues.solve();
  CHECK(tissues.report().force == 0.0);
}

TEST_CASE("a tissue of which nothing is left touches nothing", "[contact][touching][cut]") {
  const auto remove_all = [](auto& stack) {
    stack.below.set_pose(lowered(-0.4e-3));
    TouchingTissues tissues(stack.below, stack.above);
    CutOrder all;
    for (Index e = 0; e < stack.above.body().mesh.element_count(); ++e) all.remove.push_back(e);
    CHECK(press_and_cut(tissues, [&] { stack.above.cut(all); }) == 0.0);
    CHECK(tissues.report().force == 0.0);
  };
  Stack<Static, Cut> linear_stack(3);
  remove_all(linear_stack);
  Stack<Static, CutMoving> moving_stack(3);
  remove_all(moving_stack);
}

TEST_CASE("a moving tissue that was cut and is reset steps on", "[contact][touching][cut]") {
  Stack<Static, CutMoving> stack(3, 1);
  stack.below.set_pose(lowered(-0.4e-3));
  TouchingTissues tissues(stack.below, stack.above);
  stack.above.cut(slit());
  finish(tissues);
  const double cut = tissues.report().force;
  stack.above.reset();
  tissues.background_work();  // beside the surface of before
  tissues.reset();
  finish(tissues);
  CHECK(tissues.report().force > cut);
}

TEST_CASE("touching tissues that were cut obey the laws of tissues", "[contact][touching][cut][laws]") {
  Stack<Static, Cut> stack(4);
  stack.below.set_pose(lowered(-0.3e-3));
  TouchingTissues tissues(stack.below, stack.above);
  cut_twice(stack.above);
  finish(tissues);
  TouchingTissue& tissue = tissues.tissue(1);
  tissue.begin_tick();
  std::vector<int> vertices;
  const ContactSurface& surface = tissue.contact_surface();
  for (int v = 0; v < surface.vertex_count(); v += 3)
    if (!surface.triangles_at(v).empty()) vertices.push_back(v);
  CHECK(testing::tissue_laws(tissue, vertices).empty());
}

TEST_CASE("ticks at touching tissues do not allocate while these are cut by a worker", "[contact][touching][cut]") {
  Stack<Cut, CutMoving> stack(4, 1);
  TouchingTissues tissues(stack.below, stack.above);
  HapticServo servo(tissues.group(), SphereTool{4e-3}, open_options());
  const BackgroundWorker worker(tissues);
  ToolState state;
  std::uint64_t allocations = 0;
  bool finite = true;
  for (int t = 0; t < 3000; ++t) {
    state.time += 1e-3;
    state.position = {0.5 * side, 0.5 * side, 10e-3 - std::min(1.0, t / 1000.0) * 2e-3};
    if (t == 1000) stack.above.cut(slit());
    if (t == 1500) stack.below.cut(CutOrder{.remove = {0, 1, 2}, .open = {}});
    if (t == 2000) stack.above.cut(notch(stack.above));
    const testing::AllocationScope scope;
    finite = servo.tick(state).force().allFinite() && finite;
    allocations += scope.allocations();
  }
  CHECK(allocations == 0);
  CHECK(finite);
  CHECK(worker.report().failure.empty());
}

TEST_CASE("organs that are cut while tools press them enter each other by less than 3 % of a facet, or are flagged",
          "[contact][touching][cut]") {
  testing::Random random(11);
  SolutionCounts counts;
  for (int session = 0; session < 4; ++session) {
    const double r = random.uniform(8e-3, 14e-3);
    const int cells = 4 + session % 2;
    Cut below(box(2.0 * r, 2.0 * r, {cells, cells, cells}, -r, -r), Scene().fix("z0").touch("surface"),
              linear(random.uniform(3e3, 20e3)));
    Cut above(sphere_tet4(r, 9 - cells),
              Scene().fix(where::below({-0.7 * r, 0.0, 0.0}, Vector3::UnitX())).touch("surface"),
              linear(random.uniform(3e3, 20e3), 0.3));
    above.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 2.0 * r - random.uniform(-0.3e-3, 0.6e-3))));
    TouchingTissues tissues(below, above);
    const auto cut_at_random = [&](int t) {
      if (t % 10 == 9)
        for (int i = 0; i < 3; ++i) tissues.background_work();
      if (t % 50 != 30) return;
      const bool is_below = t % 100 == 30;
      Cut& cut = is_below ? below : above;
      const double angle = random.uniform(0.0, 6.28), top = (is_below ? 1.2 : 2.8) * r;
      const Vector3 along = random.uniform(0.5, 1.0) * r * Vector3(std::cos(angle), std::sin(angle), 0.0),
                    x = Vector3(random.uniform(-0.5, 0.5) * r, random.uniform(-0.5, 0.5) * r, top) - 0.5 * along;
      cut.cut(BladeSweep{x, x + along, x - Vector3(0.0, 0.0, r), x + along - Vector3(0.0, 0.0, r)});
    };
    press_around(tissues, r, cut_at_random, counts);
    CHECK(below.cut_report().cuts + above.cut_report().cuts >= 5);  // of 8, some in the air
  }
  CHECK(counts.flagged < counts.all / 4);
}

}  // namespace touching_cut_tissues_test
