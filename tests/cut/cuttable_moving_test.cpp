// Moving tissue at large strain that is cut, against models made of what a cut leaves.
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include <chrono>
#include <thread>

#include "model/one_session.hpp"

using namespace palpate;

namespace {

template <class E>
using CutMoving = HapticFEModel<E, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>>;
using Smooth = CutMoving<Smoothed<Tet4>>;
static_assert(TissueModel<Smooth> && AnnouncesChanges<Smooth> && HasBackgroundWork<Smooth>);

const NeoHookean flesh{5e3, 0.4, 1000.0};
const Vector3 weight(0.5, 0.0, -2.0);

template <class E>
Mesh<E> steak() {
  if constexpr (E::nodes == 10)
    return promote<E>(box_tet4({0.08, 0.04, 0.04}, {4, 2, 2}, BoxSplit::six));
  else
    return copy_mesh<E>(box_tet4({0.08, 0.04, 0.04}, {8, 4, 4}, BoxSplit::six));
}
Scene on_its_side() {
  return Scene().fix("x0").touch("z1").gravity(weight);
}
QuasiNewtonParameters exact_parameters() {
  return {.inertia = false, .maximum_iterations = 200, .tolerance = 1e-9};
}
template <class Model>
void step_to_rest(Model& model) {
  MotionStep done;
  for (int k = 0; k < 6; ++k) done = model.advance();
  CHECK(done.taken);
  CHECK(done.status.ok());
  CHECK(done.relative_residual <= 1e-6);
}
/// Largest difference of a cut tissue from a model of its supported elements alone with these loads, relative to the
/// displacement [m].
template <class E>
double difference_from_remains(CutMoving<E>& tissue, Scene scene = Scene().gravity(weight)) {
  std::vector<NodeId> node_map;
  std::vector<Index> element_map;
  Mesh<E> remains;
  tissue.read([&](const CutTopology<E>& t) { remains = t.extract(ElementState::supported, node_map, element_map); });
  scene.fix("x0").touch("x1");
  const auto alone = SolverTraits<Implicit<QuasiNewton<>>>::make_motion(
                         make_hyperelastic_body(remains, std::vector{flesh}), scene, exact_parameters(), {})
                         .motion;
  for (int k = 0; k < 6; ++k) alone->step(0.016);
  const VectorX u = tissue.displacement(), &expected = alone->displacement();
  double most = 0.0;
  for (std::size_t i = 0; i < node_map.size(); ++i)
    if (node_map[i] >= 0)
      most = std::max(most, (node_vector(u, static_cast<Index>(i)) - node_vector(expected, Index{node_map[i]})).norm());
  return most / expected.cwiseAbs().maxCoeff();
}
/// Elements with their centre in a box.
template <class Model>
std::vector<Index> elements_in(const Model& model, const Vector3& low, const Vector3& high) {
  const auto& mesh = model.mesh();
  std::vector<Index> inside;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    Vector3 centre = model.origin();
    for (const NodeId i : mesh.elements[static_cast<std::size_t>(e)])
      centre += mesh.position(Index{i}) / Model::ElementType::nodes;
    if ((centre - low).minCoeff() > 0.0 && (high - centre).minCoeff() > 0.0) inside.push_back(e);
  }
  return inside;
}

}  // namespace

TEST_CASE("tissue that can be cut runs the session program of all models", "[cut][moving][haptic]") {
  one_session::run<Smooth>();
}

TEMPLATE_TEST_CASE("after cuts a moving tissue rests like a model of what is left", "[cut][moving]", Tet4,
                   Smoothed<Tet4>, Tet10) {
  CutMoving<TestType> tissue(steak<TestType>(), on_its_side(), flesh, {}, exact_parameters());
  step_to_rest(tissue);
  CHECK(difference_from_remains(tissue) <= 1e-5);
  tissue.cut(CutOrder{elements_in(tissue, {0.02, -1, 0.02}, {0.04, 1, 1}), {}});  // a notch
  step_to_rest(tissue);
  CHECK(tissue.cut_report().cuts == 1);
  CHECK(difference_from_remains(tissue) <= 1e-5);
  const Index nodes = tissue.displacement().size();
  tissue.cut(BladeSweep{{0.05, -1, -0.5}, {0.05, 1, -0.5}, {0.05, -1, 0.012}, {0.05, 1, 0.012}});  // a slit from below
  step_to_rest(tissue);
  CHECK(tissue.cut_report().cuts == 2);
  CHECK(tissue.displacement().size() > nodes);
  CHECK(difference_from_remains(tissue) <= 1e-5);
  // The same with the factor of the remaining body.
  for (int k = 0; k < 500 && tissue.cut_report().renewals == 0; ++k) {
    tissue.advance();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CHECK(tissue.cut_report().renewals > 0);
  step_to_rest(tissue);
  CHECK(difference_from_remains(tissue) <= 1e-5);
  tissue.reset();
  step_to_rest(tissue);
  CHECK(tissue.displacement().size() == 3 * tissue.mesh().node_count());
  CHECK(difference_from_remains(tissue) <= 1e-5);
}

TEMPLATE_TEST_CASE("after cuts all loads act on what is left", "[cut][moving]", Tet4, Smoothed<Tet4>, Tet10) {
  const auto [name, loads] = GENERATE(table<std::string, Scene>(
      {{"body load", Scene().body_load(everywhere, {0.0, 0.0, -1000.0})},
       {"traction", Scene().traction("z1", {0.0, 0.0, -40.0})},
       {"pressure", Scene().pressure("z1", 40.0)},
       {"all with weight", Scene().gravity(weight).pressure("z1", 20.0).traction("x1", {0.0, 1.0, 0.0})}}));
  INFO(name);
  Scene scene = loads;
  scene.fix("x0").touch("z1");
  CutMoving<TestType> tissue(steak<TestType>(), scene, flesh, {}, exact_parameters());
  step_to_rest(tissue);
  CHECK(difference_from_remains(tissue, loads) <= 1e-5);
  SECTION("a notch") {
    tissue.cut(CutOrder{elements_in(tissue, {0.02, -1, 0.02}, {0.05, 1, 1}), {}});
  }
  SECTION("a slit from above") {
    tissue.cut(BladeSweep{{0.045, -1, 0.5}, {0.045, 1, 0.5}, {0.045, -1, 0.012}, {0.045, 1, 0.012}});
  }
  SECTION("split lengthwise") {
    tissue.cut(BladeSweep{{-1, 0.0201, 0.5}, {-1, 0.0201, -0.5}, {1, 0.0201, 0.5}, {1, 0.0201, -0.5}});
  }
  step_to_rest(tissue);
  CHECK(tissue.cut_report().cuts == 1);
  CHECK(difference_from_remains(tissue, loads) <= 1e-5);
  tissue.set_conditions(Scene(scene).traction("z1", {0.0, 0.0, 10.0}));
  step_to_rest(tissue);
  CHECK(difference_from_remains(tissue, Scene(loads).traction("z1", {0.0, 0.0, 10.0})) <= 1e-5);
  tissue.cut(CutOrder{elements_in(tissue, {0.06, -1, 0.02}, {0.081, 1, 1}), {}});  // the loads in force, not the first
  step_to_rest(tissue);
  CHECK(difference_from_remains(tissue, Scene(loads).traction("z1", {0.0, 0.0, 10.0})) <= 1e-5);
  tissue.reset();
  step_to_rest(tissue);
  CHECK(difference_from_remains(tissue, loads) <= 1e-5);
}

TEST_CASE("a moving tissue passes the tissue law suite while it is cut", "[cut][moving]") {
  Smooth tissue(steak<Smoothed<Tet4>>(), on_its_side(), flesh);
  const auto check = [&] {
    std::vector<int> used;
    for (int v = 0; v < tissue.contact_surface().vertex_count(); v += 5)
      if (!tissue.contact_surface().triangles_at(v).empty()) used.push_back(v);
    for (const auto& broken : testing::tissue_laws(tissue, used, {1e-5}))
      FAIL_CHECK(broken.law << ' ' << broken.detail);
  };
  tissue.advance();
  tissue.begin_tick();
  check();
  const int vertices = tissue.contact_surface().vertex_count();
  tissue.cut(BladeSweep{{0.05, -1, 0.015}, {0.05, 1, 0.015}, {0.05, -1, 1}, {0.05, 1, 1}});
  CHECK(tissue.begin_tick().has(StatusFlag::degraded_model));
  tissue.advance();
  CHECK(tissue.begin_tick().ok());
  CHECK(tissue.contact_surface().vertex_count() > vertices);  // the walls of the cut can be touched
  check();
  tissue.cut(CutOrder{{0, 1, 2, 3, 4, 5}, {}});
  tissue.advance();
  tissue.begin_tick();
  check();
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, tissue.cut(CutOrder{{1000000}, {}}));
}

TEST_CASE("a blade is the only tool on moving tissue", "[cut][moving][blade][extreme][F3]") {
  using namespace one_session;
  Smooth tissue(block(), constrained_block(), flesh, {}, {.inertia = false});
  const int vertices = tissue.contact_surface().vertex_count();
  HapticServo servo(tissue, BladeTool{.edge = {0.0, 0.04, 0.0}, .toughness = 40.0}, stiff_device());
  for (int k = 0; k < 600; ++k) {
    if (k % 16 == 15) tissue.advance();
    ToolState state;
    state.time = 1e-3 * k;
    state.position = {0.0301, 0.01, 0.033 - 5e-5 * k};
    REQUIRE(servo.tick(state).force().allFinite());
  }
  CHECK(tissue.cut_report().cuts > 1);
  CHECK(tissue.contact_surface().vertex_count() > vertices);
  CHECK(servo.tick_view().blade()->area() > 1e-4);
}

TEST_CASE("moving tissue survives lack of memory in a cut", "[cut][moving][extreme][E10]") {
  if (!testing::allocations_are_counted()) return;
  const BladeSweep slit{{0.0201, -1, 0.01}, {0.0201, 1, 0.01}, {0.0201, -1, 1}, {0.0201, 1, 1}};
  const auto mesh = copy_mesh<Smoothed<Tet4>>(box_tet4({0.04, 0.04, 0.02}, {2, 2, 2}));
  Smooth whole(mesh, Scene().fix("z0").touch("z1"), flesh, {}, {.inertia = false});
  whole.cut(slit);
  whole.advance();
  const Index size = whole.displacement().size();
  bool was_refused = true;
  for (std::uint64_t n = 0; was_refused; n += 1 + n / 50) {
    INFO("allocation " << n << " fails");
    Smooth tissue(mesh, Scene().fix("z0").touch("z1"), flesh, {}, {.inertia = false});
    tissue.cut(slit);
    const std::uint64_t refused = testing::detail::heap_calls_now().failed;
    {
      const testing::FailingHeap failing(n);
      tissue.advance();
    }
    was_refused = testing::detail::heap_calls_now().failed > refused;
    tissue.advance();
    CHECK(tissue.displacement().allFinite());
    tissue.reset();
    tissue.cut(slit);
    tissue.advance();
    CHECK(tissue.displacement().size() == size);
    CHECK_FALSE(tissue.cut_report().failed);
  }
}

TEST_CASE("the last tick before a reset may name vertices that the reset drops", "[cut][moving][haptic]") {
  using namespace one_session;
  Smooth tissue(block(), constrained_block(), flesh, {}, {.inertia = false});
  const VectorX start = tissue.displacement();
  const int vertices = tissue.contact_surface().vertex_count();
  HapticServo servo(tissue, SphereTool{radius}, stiff_device());
  tissue.cut(BladeSweep{{0.031, -1, 0.01}, {0.031, 1, 0.01}, {0.031, -1, 1}, {0.031, 1, 1}});
  for (int k = 0; k < 100; ++k) {
    if (k % 10 == 9) tissue.advance();
    ToolState state;
    state.time = 1e-3 * k;
    state.position = {0.031, 0.03, size[2] + radius - 4e-5 * k};
    REQUIRE(servo.tick(state).force().allFinite());
  }
  REQUIRE(tissue.contact_surface().vertex_count() > vertices);
  tissue.reset();
  servo.reset();  // reports the end of a press on the surface with the cut
  tissue.advance();
  CHECK(tissue.displacement().size() == start.size());
  CHECK((tissue.displacement() - start).norm() <= 1e-9);
  tissue.begin_tick();
  CHECK(tissue.contact_surface().vertex_count() == vertices);
}

TEMPLATE_TEST_CASE("vertices keep their nodes over cuts and resets", "[cut][moving]", Tet4, Smoothed<Tet4>, Tet10) {
  CutMoving<TestType> tissue(steak<TestType>(), on_its_side(), flesh);
  const std::vector<Triangle> triangles = tissue.contact_surface().triangles();
  const std::vector<Vector3> positions = tissue.contact_surface().positions();
  const auto farthest = [&] {
    const VectorX u = tissue.displacement();
    double most = 0.0;
    for (std::size_t v = 0; v < tissue.touchable_nodes().size(); ++v) {
      const NodeId node = tissue.touchable_nodes()[v];
      const Vector3 expected = tissue.rest_position(node) - tissue.origin() + node_vector(u, Index{node});
      most = std::max(most, (tissue.contact_surface().position(static_cast<int>(v)) - expected).norm());
    }
    return most;
  };
  CHECK(farthest() <= 1e-12);
  tissue.cut(CutOrder{elements_in(tissue, {0.07, 0.0, 0.0}, {0.08, 0.04, 0.04}), {}});
  tissue.advance();
  (void)tissue.begin_tick();
  CHECK(tissue.contact_surface().triangles().size() != triangles.size());
  CHECK(farthest() <= 1e-12);
  tissue.reset();
  (void)tissue.begin_tick();
  CHECK((tissue.contact_surface().triangles() == triangles));
  CHECK((tissue.contact_surface().positions() == positions));
}

TEST_CASE("a session on moving tissue that can be cut gives bitwise the same run after reset",
          "[cut][moving][haptic]") {
  Smooth tissue(steak<Smoothed<Tet4>>(), on_its_side(), flesh, {},
                {.inertia = GENERATE(false, true), .mass_damping = 5.0});
  const SphereTool tool{.radius = 6e-3};
  std::optional<HapticServo> servo(std::in_place, tissue, tool);
  const auto forces_of_session = [&] {
    std::vector<Vector3> forces;
    for (int k = 0; k < 160; ++k) {
      if (k % 16 == 0) tissue.advance();
      ToolState state;
      state.time = 1e-3 * k;
      state.position = {0.03 + 5e-5 * k, 0.02, 0.04 + 6e-3 - 8e-5 * k};
      servo->tick(state);
      forces.push_back(servo->tick_view().contact_force());
    }
    return forces;
  };
  const std::vector<Vector3> first = forces_of_session();
  CHECK(first.back().norm() > 0.01);
  SECTION("without a cut") {}
  SECTION("after a cut far from the tool") {
    tissue.cut(CutOrder{elements_in(tissue, {0.07, 0.0, 0.0}, {0.08, 0.04, 0.04}), {}});
    tissue.advance();
  }
  SECTION("the tissue is reset before the servo") {
    tissue.reset();
  }
  servo->reset();
  tissue.reset();
  CHECK((forces_of_session() == first));
  tissue.reset();
  servo.reset();
  servo.emplace(tissue, tool);
  CHECK((forces_of_session() == first));
}

TEST_CASE("burning and slitting under a tool: forces continue, and end as in a model of what is left",
          "[cut][moving][haptic][extreme][F3]") {
  using namespace one_session;
  Smooth tissue(block(), constrained_block(), flesh, {}, {.inertia = false});
  HapticServo servo(tissue, SphereTool{radius}, stiff_device());
  double time = 0.0, next = 0.0, depth = 0.0;
  Vector3 last = Vector3::Zero();
  double largest_jump = 0.0;
  const auto ticks = [&](int count) {
    for (int k = 0; k < count; ++k, time += 1e-3) {
      if (time >= next - 1e-9) next += tissue.background_work().next;
      depth = std::min(0.005, depth + 2e-5);
      ToolState state;
      state.time = time;
      state.position = Vector3(0.5 * size[0], 0.5 * size[1], size[2] + radius - depth);
      const Vector3 force = servo.tick(state).force();
      REQUIRE(force.allFinite());
      largest_jump = std::max(largest_jump, (force - last).norm());
      last = force;
    }
  };
  ticks(600);
  const double whole = last[2];
  CHECK(whole > 0.2);
  largest_jump = 0.0;
  const std::vector<Index> below = elements_in(tissue, {0.02, 0.02, 0.0}, {0.04, 0.04, 0.015});
  for (std::size_t k = 0; k + 4 <= below.size(); k += 4) {
    tissue.cut(CutOrder{{below[k], below[k + 1], below[k + 2], below[k + 3]}, {}});
    ticks(16);
  }
  ticks(600);
  CHECK(tissue.cut_report().cuts > 2);
  CHECK(last[2] < 0.9 * whole);
  CHECK(last[2] > 0.05 * whole);
  INFO("largest jump " << largest_jump << " of " << whole);
  CHECK(largest_jump < 0.1 * whole);
  std::vector<NodeId> node_map;
  std::vector<Index> element_map;
  Mesh<Smoothed<Tet4>> remains;
  tissue.read([&](const auto& t) { remains = t.extract(ElementState::supported, node_map, element_map); });
  for (Vector3& x : remains.positions) x += tissue.origin();
  HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>> alone(remains, Scene().fix("z0").touch("surface"),
                                                                           flesh, {}, {.inertia = false});
  HapticServo other(alone, SphereTool{radius}, stiff_device());
  const Vector3 expected = press(alone, other, 0.005, 1200).back();
  CHECK((last - expected).norm() <= 0.08 * expected.norm());  // the points near the hole have what they had before it

  const Vector3 half = Vector3(0.5 * size[0], -1.0, 0.5 * size[2]);
  const Index nodes = tissue.displacement().size();
  tissue.cut(BladeSweep{half, half + Vector3(0, 2, 0), half + Vector3(0, 0, 1), half + Vector3(0, 2, 1)});
  ticks(700);
  CHECK(tissue.displacement().size() > nodes);
  INFO("force " << last[2] << " after " << expected[2]);
  CHECK(last[2] < expected[2]);
  CHECK(last[2] > 0.05 * whole);
  largest_jump = 0.0;
  ticks(200);
  CHECK(largest_jump < 0.01 * whole);  // then it is steady
  CHECK(!tissue.cut_report().failed);
}

TEST_CASE("a slit under a pressing tool: from the next step on the force is near the one at rest",
          "[cut][moving][haptic][extreme][F3]") {
  using namespace one_session;
  for (const double beside : {0.0, 0.003, 0.007})
    for (const int wait : {0, 30}) {  // [ms] before every step: without and with a new factor from the thread
      Smooth tissue(block(), constrained_block(), flesh, {}, {.inertia = false});
      HapticServo servo(tissue, SphereTool{radius}, stiff_device());
      double time = 0.0, next = 0.0;
      std::vector<double> forces;
      const auto ticks = [&](int count) {
        for (int k = 0; k < count; ++k, time += 1e-3) {
          if (time >= next - 1e-9) {
            if (!forces.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(wait));
            next += tissue.background_work().next;
          }
          ToolState state;
          state.time = time;
          state.position =
              Vector3(0.5 * size[0] + beside, 0.5 * size[1], size[2] + radius - std::min(0.005, 0.02 * time));
          forces.push_back(servo.tick(state).force()[2]);
        }
      };
      ticks(600);
      const double before = forces.back();
      forces.clear();
      const Vector3 half = Vector3(0.5 * size[0], -1.0, 0.5 * size[2]);
      const Index nodes = tissue.displacement().size();
      tissue.cut(BladeSweep{half, half + Vector3(0, 2, 0), half + Vector3(0, 0, 1), half + Vector3(0, 2, 1)});
      ticks(160);
      const std::vector<double> first = forces;
      ticks(400);
      CHECK(tissue.displacement().size() > nodes);
      const double after = forces.back();
      CHECK(after < 0.99 * before);
      double farthest = 0.0;
      for (const double f : first) farthest = std::max(farthest, std::min(std::abs(f - before), std::abs(f - after)));
      INFO("tool " << beside << " m beside, wait " << wait << " ms: " << farthest << " of " << after);
      CHECK(farthest < 0.06 * after);
    }
}

TEST_CASE("a moving tissue is cut at random until nothing is left", "[cut][moving][extreme][F1][F3]") {
  for (const bool inertia : {false, true}) {
    Smooth tissue(steak<Smoothed<Tet4>>(), on_its_side(), flesh, {}, {.inertia = inertia, .mass_damping = 5.0});
    testing::Random random(17);
    std::vector<Index> left;
    for (Index e = 0; e < tissue.mesh().element_count(); ++e) left.push_back(e);
    double farthest = 0.0;
    for (int k = 0; !left.empty(); ++k) {
      CutOrder order;
      for (int burnt = 0; burnt < 12 && !left.empty(); ++burnt) {
        const auto at = static_cast<std::ptrdiff_t>(random.uniform(0.0, static_cast<double>(left.size()) - 1e-9));
        order.remove.push_back(left[static_cast<std::size_t>(at)]);
        left.erase(left.begin() + at);
      }
      tissue.cut(order);
      if (k % 5 == 0) {
        const Vector3 p = random.vector<3>(0.0, 0.08), q = random.vector<3>(-0.1, 0.1), d = random.vector<3>(-0.1, 0.1);
        tissue.cut(BladeSweep{p - q - d, p + q - d, p - q + d, p + q + d});
      }
      const MotionStep done = tissue.advance();
      CHECK((done.taken || !done.status.ok()));
      tissue.begin_tick();
      const VectorX u = tissue.displacement();
      REQUIRE(u.allFinite());
      farthest = std::max(farthest, u.cwiseAbs().maxCoeff());
      for (const Vector3& x : tissue.contact_surface().positions()) REQUIRE(all_finite(x));
    }
    CHECK(!tissue.cut_report().failed);
    INFO("farthest " << farthest);
    CHECK(farthest < 0.5);
    tissue.reset();
    for (int k = 0; k < 100; ++k) tissue.advance();
    CHECK(tissue.displacement().cwiseAbs().maxCoeff() < 0.05);
  }
}

TEST_CASE("a piece cut from moving tissue stays where it was, the rest keeps its motion", "[cut][moving][extreme]") {
  Smooth tissue(steak<Smoothed<Tet4>>(), on_its_side(), flesh, {}, {.step = 0.004, .settle = false});
  for (int k = 0; k < 10; ++k) tissue.advance();
  const VectorX before = tissue.displacement();
  const double falling = tissue.motion().velocity().norm();
  CHECK(falling > 0.0);
  tissue.cut(BladeSweep{{0.055, -1, -1}, {0.055, 1, -1}, {0.055, -1, 1}, {0.055, 1, 1}});
  tissue.advance();
  const VectorX after = tissue.displacement();
  std::vector<char> detached;
  tissue.read([&](const CutTopology<Smoothed<Tet4>>& t) {
    REQUIRE(t.detached_fragments().size() == 1);
    detached.assign(static_cast<std::size_t>(t.mesh().node_count()), 0);
    for (const NodeId i : t.detached_fragments()[0].nodes) {
      detached[static_cast<std::size_t>(i)] = 1;
      const NodeId parent = t.copied_from(i);
      CHECK(node_vector(after, Index{i}) == node_vector(before, Index{parent}));
    }
  });
  double faster = 0.0;
  for (std::size_t i = 0; i < detached.size(); ++i)
    if (detached[i] == 0) faster += node_vector(tissue.motion().velocity(), static_cast<Index>(i)).squaredNorm();
  CHECK(std::sqrt(faster) > 0.3 * falling);
  CHECK(std::sqrt(faster) < 1.5 * falling);
}

TEST_CASE("moving tissue that cannot be cut is refused", "[cut][moving][extreme]") {
  const auto refusal = [](const QuasiNewtonParameters& p) {
    return test::refusal_kind([&] { Smooth tissue(steak<Smoothed<Tet4>>(), on_its_side(), flesh, {}, p); });
  };
  CHECK(refusal({.inertia = false, .large_strain_within = 0.01}) == "unsupported");
  CHECK(refusal({.renew_factor = true}) == "unsupported");
}
