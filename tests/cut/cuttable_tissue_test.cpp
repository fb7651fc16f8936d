#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/cut/cuttable.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include <algorithm>
#include <chrono>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

using Tissue = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
static_assert(TissueModel<Tissue> && AnnouncesChanges<Tissue>);

const LinearElastic soft{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0};

Mesh<Tet4> slab() {
  return box_tet4({0.1, 0.1, 0.05}, {8, 8, 4}, BoxSplit::six);
}
Scene constrained_below() {
  return Scene().fix("z0").touch("surface").gravity({0.0, 0.0, -9.81});
}
BladeSweep slit_at(double x, double bottom) {
  return {{x, -1, bottom}, {x, 2, bottom}, {x, -1, 1}, {x, 2, 1}};
}
std::vector<int> used_vertices(const Tissue& tissue, std::size_t most) {
  std::vector<int> used;
  for (int v = 0; v < tissue.contact_surface().vertex_count(); v += 7)
    if (!tissue.contact_surface().triangles_at(v).empty() && used.size() < most) used.push_back(v);
  return used;
}
ToolState at(const Vector3& x, double time) {
  ToolState s;
  s.position = x;
  s.time = time;
  s.valid = true;
  return s;
}

using Uncut = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;

/// Soft on the left of x = 0.05, a hundred times as stiff on the right; its top can be touched.
Mesh<Tet4> two_halves() {
  Mesh<Tet4> mesh = slab();
  mesh.region_names = {"left", "right"};
  for (Index e = 0; e < mesh.element_count(); ++e)
    mesh.regions.push_back(element_nodes<Tet4>(mesh, e).col(0).mean() > 0.05 ? 1 : 0);
  return mesh;
}
const RegionMaterials<LinearElastic> halves{{"left", {.youngs_modulus = 5e3, .poisson_ratio = 0.4}},
                                            {"right", {.youngs_modulus = 5e5, .poisson_ratio = 0.3}}};
const Scene top = Scene().fix("z0").touch("z1");
/// Facets are 18 mm long.
constexpr SphereTool tip{.radius = 1e-3};

/// Forces and flags of a sphere that moves over the places in turn, in steps of 0.1 mm.
std::vector<GatedForce> forces_along(HapticServo& servo, const std::vector<Vector3>& places, double& time) {
  std::vector<GatedForce> forces;
  for (std::size_t k = 1; k < places.size(); ++k) {
    const int ticks = std::max(1, static_cast<int>((places[k] - places[k - 1]).norm() / 1e-4));
    for (int i = 1; i <= ticks; ++i)
      forces.push_back(servo.tick(at(places[k - 1] + (places[k] - places[k - 1]) * i / ticks, time += 1e-3)));
  }
  return forces;
}

}  // namespace

TEST_CASE("a tissue passes the tissue law suite while it is cut", "[cut]") {
  Tissue tissue(slab(), constrained_below(), soft, {}, {.cuttable = Selection("surface")});
  const auto check = [&] {
    tissue.begin_tick();
    for (const auto& broken : testing::tissue_laws(tissue, used_vertices(tissue, 20)))
      FAIL_CHECK(broken.law << ' ' << broken.detail);
  };
  check();
  const int vertices = tissue.contact_surface().vertex_count();
  tissue.cut(slit_at(0.052, 0.02));
  CHECK(tissue.begin_tick().has(StatusFlag::degraded_model));
  CHECK(tissue.process_cuts());
  CHECK(tissue.begin_tick().ok());  // published and folded; deferred checks come later
  CHECK(tissue.cut_report().unchecked == 1);
  int checks = 0;
  while (tissue.process_cuts()) ++checks;
  CHECK(checks == 3);
  CHECK(tissue.cut_report().unchecked == 0);
  CHECK(tissue.begin_tick().ok());
  CHECK(tissue.contact_surface().vertex_count() > vertices);  // the walls of the cut can be touched
  CHECK(tissue.cut_report().error < 1e-10);
  check();
  tissue.cut(CutOrder{{0, 1, 2, 3, 4, 5}, {}});
  tissue.process_cuts();
  check();
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, tissue.cut(CutOrder{{1000000}, {}}));
}

TEST_CASE("refusals at construction report ids of the given mesh", "[cut]") {
  using Ids = std::vector<std::int64_t>;
  Mesh<Tet4> mesh = box_tet4({0.04, 0.04, 0.04}, {2, 2, 2});
  mesh.positions.insert(mesh.positions.begin(), Vector3(0.0, 0.0, 1.0));  // used by no element: it is dropped
  for (auto& e : mesh.elements)
    for (NodeId& i : e) ++i;
  mesh.groups = {};
  const std::vector<NodeId> bottom{1, 2, 3, 4, 5, 6, 7, 8, 9}, one{5};
  const Scene constrained = Scene().fix(bottom).touch("surface");
  const SetupProblem twice = test::refusal([&] {
    Tissue(mesh, Scene(constrained).prescribe(one, {1e-3, 0.0, 0.0}), soft);
  });
  CHECK(to_string(twice.kind) == "conflicting_conditions");
  CHECK(twice.ids == Ids{5});

  auto flat = mesh.elements.front();  // dropped as well
  flat[3] = static_cast<NodeId>(mesh.positions.size());
  const auto at = [&](NodeId node) { return mesh.positions[static_cast<std::size_t>(node)]; };
  mesh.positions.push_back(Vector3(0.5 * (at(flat[0]) + at(flat[1]))));
  mesh.elements.insert(mesh.elements.begin(), flat);
  SetupOptions mending;
  mending.admission.degenerate = Admission::repair;
  const SetupProblem refused = test::refusal([&] { Tissue(mesh, Scene().touch("surface"), soft, mending); });
  CHECK(to_string(refused.kind) == "unconstrained");
  REQUIRE(!refused.ids.empty());
  CHECK(refused.ids.front() == 1);
  CHECK(refused.count == 40);
}

TEST_CASE("forces on vertices that do not exist are refused", "[cut]") {
  Tissue tissue(box_tet4({0.04, 0.04, 0.04}, {2, 2, 2}), Scene().fix("z0").touch("surface"), soft);
  const VectorX rest = tissue.displacement({});
  for (const int vertex : {-1, tissue.contact_surface().vertex_count(), 1000000})
    CHECK_REFUSED(SetupErrorKind::index_out_of_range,
                  tissue.displacement(std::array{VertexForce{vertex, {1.0, 0.0, 0.0}}}));
  CHECK_REFUSED(SetupErrorKind::non_finite, tissue.displacement(std::array{VertexForce{0, {infinity, 0.0, 0.0}}}));
  CHECK(tissue.displacement({}) == rest);
}

TEST_CASE("vertices of tissue that can be cut belong to the touchable nodes, before and after a cut", "[cut]") {
  Tissue tissue(slab(), constrained_below(), soft);
  for (int cuts = 0; cuts < 2; ++cuts) {
    const VectorX u = tissue.displacement();
    double farthest = 0.0;
    for (std::size_t v = 0; v < tissue.touchable_nodes().size(); ++v) {
      const NodeId node = tissue.touchable_nodes()[v];
      const Vector3 expected = tissue.rest_position(node) - tissue.origin() + node_vector(u, Index{node});
      farthest = std::max(farthest, (tissue.contact_surface().position(static_cast<int>(v)) - expected).norm());
    }
    CHECK(farthest <= 1e-12);
    tissue.cut(slit_at(0.05, 0.02));
    tissue.process_cuts();
    (void)tissue.begin_tick();
  }
}

TEST_CASE("overstretched remains of a cut are left out of contact and reported, without failure", "[cut]") {
  // A hanging column whose middle is cut down to a few elements, far too soft for the weight they carry.
  const auto mesh = box_tet4({0.02, 0.02, 0.3}, {2, 2, 30}, BoxSplit::six);
  Tissue tissue(mesh, Scene().fix("z1").touch("surface").gravity({0.0, 0.0, -9.81}),
                LinearElastic{.youngs_modulus = 1e3, .poisson_ratio = 0.3, .density = 1000.0});
  tissue.prepare_tools(SphereTool{}.radius, {});
  CHECK(tissue.begin_tick() == Status(StatusFlag::large_displacement));  // it is longer by more than its length
  CutOrder order;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const Vector3 x = element_nodes<Tet4>(mesh, e).colwise().mean().transpose();
    if (x[2] > 0.14 && x[2] < 0.15 && (x[0] > 0.01 || x[1] > 0.01 || x[0] > x[1])) order.remove.push_back(e);
  }
  tissue.cut(order);
  const int vertices = tissue.contact_surface().vertex_count();
  const std::size_t triangles = tissue.contact_surface().triangles().size();
  while (tissue.process_cuts()) {}
  CHECK(tissue.begin_tick().has(StatusFlag::degraded_model));
  CHECK(!tissue.cut_report().failed);
  CHECK(tissue.contact_surface().vertex_count() >= vertices);
  CHECK(tissue.contact_surface().triangles().size() < triangles + 100);
  CHECK(tissue.contact_surface().triangles().size() > triangles / 2);
  for (const Triangle& t : tissue.contact_surface().triangles())
    for (std::size_t i = 0; i < 3; ++i)
      REQUIRE((tissue.contact_surface().position(t[i]) - tissue.contact_surface().position(t[(i + 1) % 3])).norm() <=
              32.0 * SphereTool{}.radius);
  // The remaining elements are cut: the lower part comes off, and all that is left is touched again.
  CutOrder rest;
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (const double z = element_nodes<Tet4>(mesh, e).col(2).mean(); z > 0.14 && z < 0.15) rest.remove.push_back(e);
  tissue.cut(rest);
  while (tissue.process_cuts()) {}
  CHECK_FALSE(tissue.begin_tick().has(StatusFlag::degraded_model));
}

TEST_CASE("a cut under the tool: the force continues, and its rate of change is limited by the gate",
          "[cut][extreme][F3]") {
  Tissue tissue(slab(), constrained_below(), soft);
  HapticServo servo(tissue, SphereTool{});
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  double time = 0.0, before = 0.0, longest_step = 0.0;
  Vector3 last = Vector3::Zero(), contact_before = Vector3::Zero();
  const auto tick = [&](double depth) {
    const ToolState s = at({0.052, 0.05, 0.05 + 4e-3 - depth}, time += 1e-3);
    const testing::AllocationScope scope;
    const GatedForce f = servo.tick({&s, 1})[0];
    const auto calls = scope.allocations() + scope.frees();
    CHECK(calls == 0);
    REQUIRE(f.force().allFinite());
    REQUIRE(f.force().norm() <= limits.peak_force * (1.0 + 1e-12));
    longest_step = std::max(longest_step, (f.force() - last).norm());
    last = f.force();
    return f;
  };
  for (int i = 0; i < 300; ++i) tick(std::min(3e-3, 5e-4 + i * 2e-5));
  before = last.norm();
  contact_before = servo.tick_view().contact_force();
  REQUIRE(before > 0.01);
  tissue.cut(slit_at(0.052, 0.012));
  CHECK(tick(3e-3).status.has(StatusFlag::degraded_model));  // not up to date, and reported
  CHECK(std::abs(servo.tick_view().contact_force().norm() - contact_before.norm()) < 0.02 * contact_before.norm());
  tissue.process_cuts();
  const GatedForce after = tick(3e-3);
  CHECK(!after.status.has(StatusFlag::degraded_model));
  CHECK(servo.tick_view().contact_force().norm() >
        0.2 * contact_before.norm());  // contact with the surface is not lost
  constexpr double of_points = 0.01;   // a slit body is softer, but its force is that of other points
  CHECK(servo.tick_view().contact_force().norm() < (1.0 + of_points) * contact_before.norm());
  for (int i = 0; i < 100; ++i) tick(3e-3);
  CHECK(last.norm() < (1.0 + of_points) * before);
  CHECK(longest_step <= limits.slew_rate * 1e-3 * (1.0 + 1e-9));
  // The rendered force equals that of a new session on the cut body.
  Tissue fresh(slab(), constrained_below(), soft);
  fresh.cut(slit_at(0.052, 0.012));
  fresh.process_cuts();
  fresh.begin_tick();
  HapticServo other(fresh, SphereTool{});
  Vector3 settled = Vector3::Zero();
  for (int i = 0; i < 400; ++i) {
    const ToolState s = at({0.052, 0.05, 0.05 + 4e-3 - std::min(3e-3, 5e-4 + i * 2e-5)}, 1e-3 * i);
    settled = other.tick({&s, 1})[0].force();
  }
  CHECK((settled - last).norm() < 0.1 * last.norm());
}

TEST_CASE("the drawn surface distinguishes faces that a cut exposed from those of the uncut body",
          "[cut][visual_surface]") {
  Tissue tissue(slab(), constrained_below(), soft);
  VisualSurface surface(tissue);
  CHECK(std::ranges::count(surface.exposed(), 1) == 0);
  const std::size_t whole = surface.triangles().size();
  tissue.cut(slit_at(0.052, 0.012));
  while (tissue.process_cuts()) {}
  REQUIRE(surface.update());
  REQUIRE(surface.exposed().size() == static_cast<std::size_t>(surface.point_count()));
  std::size_t exposed = 0, mixed = 0;
  for (const auto& t : surface.triangles()) {
    int corners = 0;
    for (const int p : t) corners += surface.exposed()[static_cast<std::size_t>(p)];
    exposed += corners == 3 ? 1 : 0;
    mixed += corners == 1 || corners == 2 ? 1 : 0;
  }
  CHECK(mixed == 0);
  CHECK(exposed > 0);
  CHECK(exposed % 2 == 0);  // both sides of every face of the slit
  CHECK(surface.triangles().size() == whole + exposed);
  tissue.reset();
  REQUIRE(surface.update());
  CHECK(std::ranges::count(surface.exposed(), 1) == 0);
}

TEST_CASE("reset under a tool and a renderer: no reference to deleted data", "[cut][extreme][F3]") {
  Tissue tissue(slab(), constrained_below(), soft);
  HapticServo servo(tissue, SphereTool{});
  VisualSurface surface(tissue);
  const Index points = surface.point_count();
  const int vertices = tissue.contact_surface().vertex_count();
  double time = 0.0;
  const auto press = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const GatedForce f = servo.tick(at({0.052, 0.05, 0.05 + 4e-3 - 6e-3}, time += 1e-3));
      REQUIRE(f.force().allFinite());
    }
  };
  tissue.cut(slit_at(0.052, 0.012));
  while (tissue.process_cuts()) {}
  press(200);
  CHECK(surface.update());
  CHECK(surface.point_count() > points);
  const auto touches_copies = [&] {
    return std::ranges::any_of(servo.tick_view().contacts(),
                               [&](const ToolContact& c) { return c.vertices[0] >= vertices; });
  };
  REQUIRE(touches_copies());  // vertices created by the cut

  tissue.reset();
  std::vector<float> positions(3 * static_cast<std::size_t>(surface.point_count())), normals(positions.size());
  CHECK_FALSE(surface.read_surface({}, positions, normals));  // its points no longer exist
  press(200);
  CHECK(tissue.contact_surface().vertex_count() == vertices);
  CHECK_FALSE(touches_copies());
  CHECK(servo.tick_view().contact_force().norm() > 0.02);
  CHECK(surface.update());
  CHECK(surface.point_count() == points);
  CHECK(tissue.cut_report().cuts == 0);
}

TEST_CASE("cut while touched until nothing is left: all forces finite and limited, no mass lost",
          "[cut][extreme][F1][F3][M15]") {
  const auto mesh = box_tet4({0.05, 0.05, 0.05}, {4, 4, 4});
  Tissue tissue(mesh, constrained_below(), soft);
  HapticServo servo(tissue, SphereTool{});
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  testing::Random random(3);
  double time = 0.0, whole = 0.0, left = 1.0;
  tissue.read([&](const auto& t, const auto& p) {
    for (Index e = 0; e < t.mesh().element_count(); ++e) whole += p.mass(t.part(e));
  });
  Vector3 last = Vector3::Zero();
  int cuts = 0;
  while (left > 0.0) {
    CutOrder order;
    for (int k = 0; k < 6; ++k) {
      const auto e = static_cast<Index>(random.uniform(0.0, static_cast<double>(mesh.element_count())));
      if (random.uniform() < 0.5 || cuts > 60)
        order.remove.push_back(e);
      else
        order.open.push_back({e, k % 4});
    }
    if (cuts > 120)
      for (Index e = 0; e < mesh.element_count(); ++e) order.remove.push_back(e);
    tissue.cut(order);
    ++cuts;
    for (int i = 0; i < 4; ++i) {
      if (i == 2) tissue.process_cuts();
      const ToolState s = at({random.uniform(0.0, 0.05), random.uniform(0.0, 0.05), 0.05}, time += 1e-3);
      const GatedForce f = servo.tick({&s, 1})[0];
      REQUIRE(f.force().allFinite());
      REQUIRE(f.force().norm() <= limits.peak_force * (1.0 + 1e-12));
      REQUIRE((f.force() - last).norm() <= limits.slew_rate * 1e-3 * (1.0 + 1e-9));
      REQUIRE(f.status.bits() < (1u << status_flag_count));
      REQUIRE(!f.status.has(StatusFlag::non_finite_force));
      last = f.force();
    }
    double supported = 0.0, detached = 0.0, removed = 0.0;
    tissue.read([&](const auto& t, const auto& p) {
      for (Index e = 0; e < t.mesh().element_count(); ++e)
        (t.state(e) == ElementState::supported  ? supported
         : t.state(e) == ElementState::detached ? detached
                                                : removed) += p.mass(t.part(e));
    });
    REQUIRE(std::abs(supported + detached + removed - whole) < 1e-12 * whole);
    left = supported + detached;
    if (supported > 0.0) REQUIRE(!tissue.cut_report().failed);
  }
  CHECK(tissue.contact_surface().triangles().empty());
  for (int i = 0; i < 200; ++i) {
    const ToolState s = at({0.02, 0.02, 0.03}, time += 1e-3);
    last = servo.tick({&s, 1})[0].force();
  }
  CHECK(last.norm() == 0.0);  // nothing left to touch
}

TEST_CASE("a detached piece stays where it was", "[cut][extreme][F1]") {
  const auto mesh = box_tet4({0.05, 0.05, 0.05}, {4, 4, 4});
  Tissue tissue(mesh, constrained_below(), soft);
  const VectorX before = tissue.displacement();
  CHECK(tissue.cut_report().displacement > 0.0);
  CHECK(tissue.cut_report().displacement < 0.1);
  tissue.cut(BladeSweep{{-1.0, -1.0, 0.03}, {1.0, -1.0, 0.03}, {-1.0, 1.0, 0.03}, {1.0, 1.0, 0.03}});
  tissue.process_cuts();
  const VectorX after = tissue.displacement();
  int kept = 0;
  tissue.read([&](const auto& topology, const auto&) {
    for (Index e = 0; e < topology.mesh().element_count(); ++e)
      for (const NodeId node : topology.mesh().elements[static_cast<std::size_t>(e)]) {
        if (topology.state(e) != ElementState::detached) continue;
        ++kept;
        const NodeId origin = topology.origin_of(node);
        REQUIRE((node_vector(after, node) - node_vector(before, origin)).norm() < 1e-9);
      }
  });
  CHECK(kept > 0);
}

TEST_CASE("remnants that sag too far are flagged, and stay in place when they are detached", "[cut][extreme][F1][F3]") {
  const auto mesh = box_tet4({0.05, 0.05, 0.05}, {4, 4, 4});
  const double diagonal = 0.05 * std::sqrt(3.0);
  int flagged = 0, detached_nodes = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Tissue tissue(mesh, constrained_below(), soft);
    testing::Random random(seed);
    for (int cuts = 0; cuts < 120; ++cuts) {
      CutOrder order;
      for (int k = 0; k < 6; ++k)
        order.open.push_back(
            {static_cast<Index>(random.uniform(0.0, static_cast<double>(mesh.element_count()))), k % 4});
      tissue.cut(order);
      tissue.process_cuts();
      REQUIRE(!tissue.cut_report().failed);
      const bool far = tissue.cut_report().displacement > 0.1;
      REQUIRE(tissue.begin_tick().has(StatusFlag::large_displacement) == far);
      flagged += far;
      const VectorX u = tissue.displacement();
      tissue.read([&](const auto& topology, const auto&) {
        for (Index e = 0; e < topology.mesh().element_count(); ++e)
          for (const NodeId node : topology.mesh().elements[static_cast<std::size_t>(e)])
            if (topology.state(e) == ElementState::detached) {
              ++detached_nodes;
              REQUIRE(node_vector(u, node).norm() <= 0.1 * diagonal * (1.0 + 1e-12));
            } else if (topology.state(e) == ElementState::supported && !far) {
              REQUIRE(node_vector(u, node).norm() < 0.25 * diagonal);
            }
      });
    }
  }
  CHECK(flagged > 0);
  CHECK(detached_nodes > 0);
}

TEST_CASE("the set-up of tissue that is cut reports memory, accuracy, stages and progress, and can be cancelled",
          "[cut][report]") {
  std::vector<std::string> stages;
  SetupOptions options;
  options.progress = [&](const Progress& p) {
    if (stages.empty() || stages.back() != p.stage) stages.emplace_back(p.stage);
    return true;
  };
  Tissue tissue(slab(), constrained_below(), soft, options);
  const SetupReport& report = tissue.report();
  const HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>> uncut(slab(), constrained_below(), soft);
  CHECK(report.stiffness_bytes == uncut.report().stiffness_bytes);
  CHECK(report.solver_bytes >= static_cast<std::size_t>(8 * report.kept_dofs * report.kept_dofs));
  CHECK(report.compliance_bytes >= 3 * static_cast<std::size_t>(8 * report.kept_dofs * report.kept_dofs));
  CHECK(report.probe_error > 0.0);
  CHECK(report.probe_error < 1e-10);
  CHECK(report.condition_estimate > 0.1 * uncut.report().condition_estimate);
  CHECK(report.condition_estimate < 10.0 * uncut.report().condition_estimate);
  for (const char* stage : {"admission", "assembly", "factorisation", "compliance", "checks"}) {
    INFO(stage);
    CHECK(std::find(stages.begin(), stages.end(), stage) != stages.end());
    CHECK(std::any_of(report.seconds.begin(), report.seconds.end(), [&](const auto& s) { return s.first == stage; }));
    SetupOptions cancelling;
    cancelling.progress = [&](const Progress& p) { return p.stage != stage; };
    CHECK_REFUSED(SetupErrorKind::cancelled, Tissue(slab(), constrained_below(), soft, cancelling));
  }
  stages.clear();
  tissue.set_gravity({0.0, 0.0, -5.0});  // makes a new factor
  CHECK(stages.empty());                 // of the set-up only
}

TEST_CASE("a deep press of linear tissue that can be cut is flagged where that of other linear tissue is",
          "[cut][extreme]") {
  const Scene scene = Scene().fix("z0").touch("z1");
  Tissue tissue(slab(), scene, soft);
  HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>> uncut(slab(), scene, soft);
  ServoOptions stiff;  // equal depths
  stiff.coupling_stiffness = infinity;
  HapticServo servo(tissue, SphereTool{.radius = 0.012}, stiff), other(uncut, SphereTool{.radius = 0.012}, stiff);
  int flagged = 0, not_flagged = 0;
  for (int k = 0; k < 500; ++k) {
    const ToolState state = at({0.052, 0.047, 0.062 - 3e-5 * k}, 1e-3 * k);
    const bool large = servo.tick(state).status.has(StatusFlag::large_displacement);
    if (other.tick(state).status.has(StatusFlag::large_displacement)) REQUIRE(large);
    ++(large ? flagged : not_flagged);
  }
  CHECK(flagged > 50);
  CHECK(not_flagged > 50);
}

TEST_CASE("before any cut a sphere much smaller than the facets feels what it feels on tissue that cannot be cut",
          "[cut][coarse]") {
  Tissue tissue(two_halves(), top, halves);
  Uncut uncut(two_halves(), top, halves);
  const double x = GENERATE(0.022, 0.048, 0.077);  // left, over the boundary of the regions, right
  HapticServo servo(tissue, tip), other(uncut, tip);
  const std::vector<Vector3> path{
      {x, 0.047, 0.0521}, {x, 0.047, 0.0507}, {x + 2e-3, 0.048, 0.0507}, {x + 2e-3, 0.048, 0.054}};
  double time = 0.0, same_time = 0.0, largest = 0.0;
  const auto forces = forces_along(servo, path, time), expected = forces_along(other, path, same_time);
  for (const GatedForce& f : expected) largest = std::max(largest, f.force().norm());
  REQUIRE(largest > 1e-4);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    CAPTURE(k, forces[k].force().norm(), expected[k].force().norm());
    REQUIRE((forces[k].force() - expected[k].force()).norm() <= 1e-6 * largest);
    REQUIRE(forces[k].status == expected[k].status);
    // The probe errors of the two factors differ, by less than their bound.
    const ForceErrorParts &own = forces[k].error.parts, &same = expected[k].error.parts;
    REQUIRE((own.conditioning > 0.0) == (same.conditioning > 0.0));
    REQUIRE(std::abs(own.linearity - same.linearity) <= 1e-6 * (largest + same.linearity));
  }
}

TEST_CASE("a small sphere keeps its dent when the tissue is cut far from it", "[cut][coarse]") {
  Tissue tissue(two_halves(), top, halves);
  HapticServo servo(tissue, tip);
  const Vector3 start(0.022, 0.047, 0.0521), pressed(0.022, 0.047, 0.0507);
  double time = 0.0;
  forces_along(servo, {start, pressed}, time);
  for (int i = 0; i < 100; ++i) servo.tick(at(pressed, time += 1e-3));
  const Vector3 before = servo.tick_view().contact_force();
  REQUIRE(before.norm() > 1e-4);
  tissue.cut(slit_at(0.0876, 0.03));
  while (tissue.process_cuts()) {}
  REQUIRE(tissue.cut_report().cuts == 1);
  for (int i = 0; i < 100; ++i) {
    const ToolState s = at(pressed, time += 1e-3);
    const testing::AllocationScope scope;
    servo.tick({&s, 1});
    const auto calls = scope.allocations() + scope.frees();
    CHECK(calls == 0);
    REQUIRE((servo.tick_view().contact_force() - before).norm() < 0.02 * before.norm());
  }
  // A new press on the cut tissue has the same dent.
  servo.reset();
  forces_along(servo, {start, pressed}, time);
  for (int i = 0; i < 100; ++i) servo.tick(at(pressed, time += 1e-3));
  CHECK((servo.tick_view().contact_force() - before).norm() < 0.02 * before.norm());
}

TEST_CASE("after every cut the surface knows the material behind each of its triangles", "[cut][coarse]") {
  Mesh<Tet4> mesh = two_halves();
  for (Vector3& x : mesh.positions) x[1] += 2.0 * std::max(0.0, x[1] - 0.05);
  Tissue tissue(mesh, Scene().fix("z0").touch("surface"), halves);
  const auto check = [&] {
    tissue.begin_tick();
    const ContactSurface& surface = tissue.contact_surface();
    int soft_ones = 0, stiff_ones = 0;
    for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t) {
      Vector3 inside = tissue.origin() - 1e-4 * surface.normal(t);
      for (const int v : surface.triangle(t)) inside += surface.position(v) / 3.0;
      const LinearElastic& material = halves[inside[0] > 0.05 ? 1 : 0].second;
      const double modulus = material.youngs_modulus / (1.0 - material.poisson_ratio * material.poisson_ratio);
      REQUIRE(std::abs(surface.material(t).modulus - modulus) < 1e-9 * modulus);
      REQUIRE(std::abs(surface.material(t).poisson_ratio - material.poisson_ratio) < 1e-9);
      ++(inside[0] > 0.05 ? stiff_ones : soft_ones);
    }
    CHECK(soft_ones > 20);
    CHECK(stiff_ones > 20);
  };
  check();
  for (const double x : {0.036, 0.0623}) {
    tissue.cut(slit_at(x, 0.02));
    while (tissue.process_cuts()) {}
    check();
  }
  tissue.cut(CutOrder{.remove = {1500, 1501, 1502, 700}, .open = {}});
  while (tissue.process_cuts()) {}
  check();
  const std::size_t all = tissue.contact_surface().triangles().size();
  tissue.prepare_tools(1e-3, {});  // too small for the long facets, which are left out
  CHECK(tissue.contact_surface().triangles().size() < all - 20);
  check();
  tissue.reset();
  check();
}

TEST_CASE("inside and outside of tissue that is cut are those of the body, where only a patch can be touched",
          "[cut][surface]") {
  Tissue tissue(slab(), top, soft);
  const auto distance = [&](double x, double y, double z) {
    return tissue.contact_surface().distance_of_body(tissue.to_world().inverse() * Vector3(x, y, z));
  };
  REQUIRE(tissue.contact_surface().has_shell());
  CHECK(distance(0.052, 0.047, 0.049) < 0.0);
  CHECK(distance(0.001, 0.047, 0.02) < 0.0);
  CHECK(distance(-0.001, 0.047, 0.02) > 0.0);
  CHECK(distance(0.052, 0.047, -0.01) > 0.0);
  Uncut uncut(slab(), top, soft);
  HapticServo servo(tissue, SphereTool{.radius = 4e-3}), other(uncut, SphereTool{.radius = 4e-3});
  const std::vector<Vector3> path{{0.05, 0.047, 0.06},  {0.051, 0.047, 0.051}, {-0.001, 0.047, 0.052},
                                  {-0.01, 0.047, 0.04}, {0.11, 0.047, 0.02},   {0.05, 0.05, -0.01}};
  double time = 0.0, same_time = 0.0, largest = 0.0;
  const auto forces = forces_along(servo, path, time), expected = forces_along(other, path, same_time);
  for (const GatedForce& f : expected) largest = std::max(largest, f.force().norm());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    CAPTURE(k, forces[k].force().norm(), expected[k].force().norm());
    REQUIRE((forces[k].force() - expected[k].force()).norm() <= 1e-6 * largest);
    REQUIRE(forces[k].status == expected[k].status);
  }
  // A corner that is burnt away is outside, and what it exposes can be touched.
  CutOrder order;
  for (Index e = 0; e < tissue.mesh().element_count(); ++e) {
    const Vector3 x = tissue.origin() + element_nodes<Tet4>(tissue.mesh(), e).colwise().mean().transpose();
    if (x[0] < 0.025 && x[1] < 0.025) order.remove.push_back(e);
  }
  tissue.cut(order);
  while (tissue.process_cuts()) {}
  tissue.begin_tick();
  CHECK(tissue.contact_surface().is_closed());
  CHECK(distance(0.01, 0.01, 0.02) > 0.0);
  CHECK(distance(0.03, 0.01, 0.02) < 0.0);
  CHECK(distance(0.03, -0.001, 0.02) > 0.0);
}

TEST_CASE("parts that touch only at an edge can be touched there when they are cut apart", "[cut][surface]") {
  // Two of the four columns of a block, which share the edge between them.
  Mesh<Tet4> block = box_tet4({0.04, 0.04, 0.04}, {2, 2, 2}, BoxSplit::six), mesh;
  std::vector<NodeId> number(block.positions.size(), -1);
  for (Index e = 0; e < block.element_count(); ++e) {
    const Vector3 x = element_nodes<Tet4>(block, e).colwise().mean().transpose();
    if ((x[0] > 0.02) != (x[1] > 0.02)) continue;
    auto nodes = block.elements[static_cast<std::size_t>(e)];
    for (NodeId& node : nodes) {
      NodeId& own = number[static_cast<std::size_t>(node)];
      if (own < 0) {
        own = static_cast<NodeId>(mesh.positions.size());
        mesh.positions.push_back(block.position(node));
      }
      node = own;
    }
    mesh.elements.push_back(nodes);
  }
  const Scene scene = Scene().fix(where::below(Vector3(0.0, 0.0, 1e-6))).touch("surface");
  Tissue tissue(mesh, scene, soft);
  CHECK(tissue.contact_surface().triangles().size() == Uncut(mesh, scene, soft).contact_surface().triangles().size());
  CHECK(tissue.contact_surface().is_closed());
}

TEST_CASE("tissue that is cut is refused to a second servo", "[cut][refused]") {
  Tissue tissue(slab(), constrained_below(), soft);
  {
    HapticServo servo(tissue, SphereTool{.radius = 0.01});
    TissueAdaptor<Tissue> same(tissue);
    CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(tissue, SphereTool{.radius = 0.01}));
    CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(same, SphereTool{.radius = 0.01}));
    CHECK(servo.tick(at({0.05, 0.05, 0.07}, 0.0)).force().isZero(0.0));
  }
  CHECK_NOTHROW(HapticServo(tissue, SphereTool{.radius = 0.01}));
}

TEST_CASE("a cut that nobody applies is flagged as such", "[cut][extreme]") {
  Tissue tissue(slab(), constrained_below(), soft);
  CHECK(tissue.begin_tick().ok());
  tissue.cut(slit_at(0.052, 0.02));
  for (int k = 1; k <= 600; ++k) {
    INFO(k);
    const Status status = tissue.begin_tick();
    REQUIRE(status.has(StatusFlag::degraded_model));
    REQUIRE(status.has(StatusFlag::stalled_tissue) == (k > 500));
  }
  tissue.process_cuts();
  CHECK(tissue.begin_tick().ok());
  for (int k = 0; k < 1000; ++k) REQUIRE(tissue.begin_tick().ok());  // nothing waits
}

TEST_CASE("a cut for which memory is short leaves the body as before it, or is completed later",
          "[cut][extreme][E10]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  const auto order = [](int k) { return slit_at(0.04 + 0.02 * k, 0.02); };
  Tissue tissue(slab(), constrained_below(), soft), reference(slab(), constrained_below(), soft);
  const std::vector<int> pressed = used_vertices(tissue, 3);
  const auto displacement = [&](Tissue& of) {
    std::vector<VertexForce> forces;
    for (const int v : pressed) forces.push_back({v, ModelVector(Vector3(0.01, 0.0, -0.05))});
    return of.displacement(forces);
  };
  const auto same = [](const VectorX& a, const VectorX& b) {
    return a.size() == b.size() && (a - b).norm() <= 1e-9 * b.norm();
  };
  std::vector<VectorX> expected{displacement(reference)};  // after 0, 1, 2 cuts
  std::vector<int> vertices{reference.contact_surface().vertex_count()};
  for (int k = 0; k < 2; ++k) {
    reference.cut(order(k));
    reference.process_cuts();
    expected.push_back(displacement(reference));
    reference.begin_tick();
    vertices.push_back(reference.contact_surface().vertex_count());
  }
  int dropped = 0, completed = 0;
  for (std::uint64_t n = 0, cuts = 0;; n += 1 + n / 60) {
    INFO("allocation " << n << " fails");
    REQUIRE(n < 1'000'000);
    tissue.cut(order(static_cast<int>(cuts)));
    bool failed = false;
    const std::uint64_t refused = testing::detail::heap_calls_now().failed;
    {
      const testing::FailingHeap failing(n);
      try {
        tissue.process_cuts();
      } catch (const std::bad_alloc&) {
        failed = true;
      }
    }
    if (tissue.cut_report().failed) CHECK(failed);  // not if the order still waits
    CHECK(tissue.begin_tick().has(StatusFlag::degraded_model) == failed);
    tissue.process_cuts();  // what is left to do
    const VectorX now = displacement(tissue);
    if (failed && same(now, expected[cuts])) {
      ++dropped;
      continue;
    }
    completed += failed;
    REQUIRE(same(now, expected[++cuts]));
    CHECK_FALSE(tissue.cut_report().failed);
    tissue.begin_tick();
    CHECK(tissue.contact_surface().vertex_count() == vertices[cuts]);
    if (cuts < 2) continue;
    if (testing::detail::heap_calls_now().failed == refused) break;
    tissue.reset();
    cuts = 0;
  }
  CHECK(dropped > 10);
  CHECK(completed > 2);
}

TEST_CASE("lack of memory in a later cut leaves the body as before it", "[cut][extreme][E10]") {
  if (!testing::allocations_are_counted()) return;
  int failures = 0;
  for (std::uint64_t n = 0; n < 40; ++n) {
    INFO("allocation " << n << " fails");
    Tissue tissue(box_tet4({0.06, 0.06, 0.03}, {4, 4, 2}), Scene().fix("z0").touch("z1"), soft);
    tissue.cut(BladeSweep{{0.031, -1, 0.01}, {0.031, 1, 0.01}, {0.031, -1, 1}, {0.031, 1, 1}});
    while (tissue.process_cuts()) {}
    const VectorX before = tissue.displacement();
    const BladeSweep second{{-1, 0.031, 0.01}, {1, 0.031, 0.01}, {-1, 0.031, 1}, {1, 0.031, 1}};
    tissue.cut(second);
    bool failed = false;  // some work goes on without memory
    {
      const testing::FailingHeap failing(n);
      try {
        tissue.process_cuts();
      } catch (const std::bad_alloc&) {
        failed = true;
      }
    }
    if (failed) CHECK(tissue.displacement() == before);
    failures += failed;
    tissue.cut(second);
    while (tissue.process_cuts()) {}
    CHECK(tissue.displacement().size() > before.size());
    tissue.reset();
  }
  CHECK(failures > 20);
}

TEST_CASE("a worker without memory for a cut stops, and ticks go on with the body before the cut", "[cut][extreme]") {
  struct Starved : TissueAdaptor<Tissue> {
    using TissueAdaptor::TissueAdaptor;
    BackgroundStep background_work() {
      const testing::FailingHeap failing(0, true);
      return tissue().background_work();
    }
  };
  if (!testing::allocations_are_counted()) return;
  Tissue tissue(slab(), constrained_below(), soft);
  Starved starved(tissue);
  HapticServo servo(starved, SphereTool{.radius = 0.01});
  const Vector3 pressing(0.05, 0.05, 0.0595);
  const Vector3 before = servo.tick(at(pressing, 0.0)).force();
  BackgroundWorker worker(starved);
  tissue.cut(slit_at(0.052, 0.02));
  for (int k = 0; k < 10000 && !worker.failed(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  REQUIRE(worker.failed());
  worker.stop();
  CHECK_THROWS_AS(worker.rethrow_failure(), std::bad_alloc);
  for (int k = 1; k < 10; ++k) {
    const GatedForce& force = servo.tick(at(pressing, 1e-3 * k));
    CHECK(force.status.has(StatusFlag::stalled_tissue));
    CHECK(force.force().norm() >= before.norm());
  }
  BackgroundWorker fed(tissue);  // the order still waits
  for (int k = 0; k < 10000 && tissue.cut_report().cuts == 0; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(tissue.cut_report().cuts == 1);
}

TEST_CASE("one thread cuts while another ticks", "[cut][extreme][F3]") {
  Tissue tissue(slab(), constrained_below(), soft);
  HapticServo servo(tissue, SphereTool{});
  const ForceLimits limits = ForceLimits::from(DeviceLimits{});
  testing::Random random(8);
  {
    const BackgroundWorker worker(tissue);
    Vector3 last = Vector3::Zero();
    for (int i = 0; i < 3000; ++i) {
      if (i % 300 == 100)
        tissue.try_cut({{0.02 + i * 2e-5, -1, 0.03},
                        {0.02 + i * 2e-5, 2, 0.03},
                        {0.02 + i * 2e-5, -1, 1},
                        {0.02 + i * 2e-5, 2, 1}});
      const ToolState s = at({0.03 + 1e-5 * i, 0.05, 0.05 + 4e-3 - 3e-3}, 1e-3 * i);
      const GatedForce f = servo.tick({&s, 1})[0];
      REQUIRE(f.force().allFinite());
      REQUIRE((f.force() - last).norm() <= limits.slew_rate * 1e-3 * (1.0 + 1e-9));
      last = f.force();
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
  while (tissue.process_cuts()) {}
  CHECK(tissue.cut_report().cuts > 1);
  CHECK(tissue.cut_report().error < 1e-10);
}
