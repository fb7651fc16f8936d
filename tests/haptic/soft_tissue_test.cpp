// Tissue that moves at its own rate under a servo with another rate.
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include <chrono>
#include <thread>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

constexpr double sphere = 0.012;
const Vector3 size(0.06, 0.06, 0.03);

Mesh<Tet4> pad() {
  return box_tet4(size, {6, 6, 3});
}
Scene pad_scene() {
  return Scene().fix("z0").touch("z1");
}
template <class Material>
using Soft = HapticFEModel<Tet4, Material, Implicit<Newton>>;

ImplicitParameters with_step(double step) {
  return {.step = step};
}
ServoOptions device() {
  ServoOptions o;
  o.devices = {{.peak_force = 20.0, .stiffness = 2000.0}};
  return o;
}

/// Without points finer than facets, as viscoelastic tissue: its half-space does not relax.
ServoOptions on_facets() {
  ServoOptions o = device();
  o.contact.subfacet_compliance = false;
  return o;
}

/// A sphere over the middle of the pad, `depth` below first contact, at tick k of a 1 kHz clock.
ToolState above(int k, double depth, double aside = 0.0) {
  ToolState s;
  s.time = 1e-3 * k;
  s.position = {0.5 * size[0] + aside, 0.5 * size[1], size[2] + sphere - depth};
  return s;
}

/// Final state of a session of ticks with tissue steps in between.
struct SoftSession {
  Vector3 force = Vector3::Zero();  ///< before the gate [N]
  double largest_change = 0.0;      ///< of the force between two ticks after the first 50 [N]
  Status status;                    ///< of the last 100 ticks
  std::vector<VertexForce> on_vertices;
};

template <class Depth>
SoftSession press(MovingTissue& tissue, int ticks, Depth depth, double from = 0.0,
                  const ServoOptions& options = device()) {
  HapticServo servo(tissue, SphereTool{.radius = sphere}, options);
  SoftSession s;
  double next = 0.0;
  Vector3 last = Vector3::Zero();
  for (int k = 0; k < ticks; ++k) {
    if (1e-3 * k >= next - 1e-9) {
      tissue.advance();
      next += tissue.step();
    }
    const GatedForce out = servo.tick({std::array{above(k, depth(1e-3 * k), from)}})[0];
    s.force = servo.tick_view().contact_force();
    REQUIRE(s.force.allFinite());
    if (k > 50) s.largest_change = std::max(s.largest_change, (s.force - last).norm());
    if (k >= ticks - 100) s.status |= out.status;
    last = s.force;
  }
  const auto forces = servo.read_snapshot().vertex_forces();
  s.on_vertices.assign(forces.begin(), forces.end());
  return s;
}
double ramp(double t) {
  return std::min(0.008, 0.02 * t);
}

}  // namespace

TEST_CASE("the steady force does not depend on the step and equals that of the static equilibrium", "[haptic][soft]") {
  std::vector<double> steady;
  for (const double h : {0.02, 0.01, 0.005, 0.001}) {
    Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(h));
    const SoftSession s = press(tissue, 2000, ramp);
    steady.push_back(s.force[2]);
    CHECK((s.status.ok() || s.status == StatusFlag::coarse_contact));
    CHECK(s.largest_change <= 0.1 * s.force[2]);
    if (h != 0.01) continue;
    Scene loaded = pad_scene();
    for (const VertexForce& f : s.on_vertices)
      loaded.point_load(std::vector<NodeId>{tissue.touchable_nodes()[static_cast<std::size_t>(f.vertex)]},
                        f.force.in_model_axes());
    Equilibrium statics(make_hyperelastic_body(pad(), std::vector<NeoHookean>{{5e3, 0.45, 1000.0}}), loaded);
    REQUIRE(statics.solve().converged);
    CHECK((statics.displacement() - tissue.motion().displacement()).norm() <= 1e-4 * statics.displacement().norm());
  }
  for (const double f : steady) CHECK_THAT(f, WithinRel(steady.back(), 1e-3));  // 1 % required
  CHECK(steady.back() > 0.3);
}

TEST_CASE("a slight touch gives the force of linear elasticity", "[haptic][soft]") {
  const auto slight = [](double t) { return std::min(0.0005, 0.01 * t); };
  Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.01));
  const double soft = press(tissue, 600, slight).force[2];
  HapticFEModel<Tet4, LinearElastic> linear(pad(), pad_scene(), LinearElastic{5e3, 0.45, 1000.0});
  HapticServo servo(linear, SphereTool{.radius = sphere}, device());
  for (int k = 0; k < 600; ++k) servo.tick({std::array{above(k, slight(1e-3 * k))}});
  CHECK_THAT(soft, WithinRel(servo.tick_view().contact_force()[2], 0.02));
}

TEST_CASE("a released tissue returns to rest, and a stalled one stays elastic", "[haptic][soft]") {
  Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.01));
  press(tissue, 500, ramp);
  const double pressed = tissue.motion().displacement().norm();
  press(tissue, 1500, [](double) { return -0.01; });
  CHECK(tissue.motion().displacement().norm() <= 0.01 * pressed);

  for (int k = 0; k < 50; ++k) tissue.advance();
  HapticServo servo(tissue, SphereTool{.radius = sphere}, device());
  double work = 0.0, depth = -0.001, most = 0.0;
  for (int k = 0; k < 400; ++k) {  // 0.4 s without a tissue step: in, hold, out
    const double next = k < 100 ? depth + 5e-5 : k < 300 ? depth : depth - 5e-5;
    servo.tick({std::array{above(k, next)}});
    work += servo.tick_view().contact_force()[2] * (next - depth);
    depth = next;
    most = std::max(most, servo.tick_view().contact_force()[2]);
  }
  CHECK(most > 0.1);
  CHECK(work >= -0.02 * most * 0.004);  // the hand gains no energy
  CHECK(servo.tick_view().contact_force()[2] == 0.0);
}

TEST_CASE("a tissue after reset knows nothing of the session before", "[haptic][soft]") {
  Soft<NeoHookean> tissue(pad(), pad_scene().gravity({0.0, 0.0, -1.0}), NeoHookean{5e3, 0.4, 1000.0});
  const VectorX start = tissue.displacement();
  const auto forces_of_session = [&] {
    HapticServo servo(tissue, SphereTool{.radius = sphere}, device());
    std::vector<Vector3> forces;
    for (int k = 0; k < 200; ++k) {
      if (k % 10 == 0) tissue.advance();
      forces.push_back(servo.tick(above(k, std::min(5e-3, 1e-4 * k))).force());
    }
    return forces;
  };
  const std::vector<Vector3> first = forces_of_session();
  CHECK(first.back()[2] > 0.1);
  tissue.reset();
  CHECK(forces_of_session() == first);
  tissue.set_gravity({0.0, 0.0, -9.81});
  tissue.reset();
  for (int k = 0; k < 10; ++k) tissue.advance();
  CHECK((tissue.displacement() - start).cwiseAbs().maxCoeff() <= 1e-12);
  tissue.reset();
  CHECK(forces_of_session() == first);
}

TEST_CASE("the tissue is settled under gravity before the first touch", "[haptic][soft]") {
  Soft<NeoHookean> tissue(pad(), pad_scene().gravity({0.0, 0.0, -9.81}), NeoHookean{5e3, 0.45, 1000.0}, {},
                          with_step(0.01));
  const VectorX u = tissue.motion().displacement();
  CHECK(u.norm() > 0.0);
  for (int k = 0; k < 20; ++k) tissue.advance();
  CHECK((tissue.motion().displacement() - u).norm() <= 1e-6 * u.norm());
}

TEST_CASE("moving tissue satisfies the laws of tissues, at rest and rotated", "[haptic][soft][laws]") {
  Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.01));
  CHECK(testing::describe(testing::tissue_laws(tissue, std::array{0, 24, 30, 48}, {1e-9})) == "");
  press(tissue, 500, ramp, 0.01);
  tissue.begin_tick();
  CHECK(testing::describe(testing::tissue_laws(tissue, std::array{0, 24, 30, 48}, {1e-9})) == "");
}

TEST_CASE("neither a tick nor a step of the tissue allocates", "[haptic][soft][allocation]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.01));
  HapticServo servo(tissue, SphereTool{.radius = sphere}, device());
  const testing::AllocationScope scope;
  for (int k = 0; k < 300; ++k) {
    if (k % 10 == 0) tissue.advance();
    const ToolState state = above(k, ramp(1e-3 * k));
    servo.tick({&state, 1});
  }
  const std::uint64_t allocations = scope.allocations();
  CHECK(allocations == 0);
}

TEST_CASE("tissue thread and ticks exchange data without waiting", "[haptic][soft]") {
  Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.005));
  HapticServo servo(tissue, SphereTool{.radius = sphere}, device());
  BackgroundWorker worker(tissue);
  double most = 0.0;
  for (int k = 0; k < 600; ++k) {
    const ToolState state = above(k, ramp(1e-3 * k));
    const GatedForce out = servo.tick({&state, 1})[0];
    REQUIRE(out.force().allFinite());
    most = std::max(most, out.force().norm());
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  worker.stop();
  CHECK(worker.report().pieces > 10);
  CHECK(worker.report().pieces == tissue.steps());
  CHECK(most > 0.05);
  CHECK(worker.report().rate > 0.0);
  CHECK(worker.report().rate <= 1.1);
}

TEST_CASE("invalid steps and bodies are refused", "[haptic][soft]") {
  const auto kind = [](const Scene& s, double step) {
    try {
      Soft<NeoHookean> tissue(pad(), s, NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(step));
    } catch (const SetupError& error) {
      return error.kind();
    }
    return SetupErrorKind::cancelled;
  };
  CHECK(kind(pad_scene(), 0.0) == SetupErrorKind::bad_argument);
  CHECK(kind(pad_scene(), std::numeric_limits<double>::quiet_NaN()) == SetupErrorKind::bad_argument);
  CHECK(kind(Scene().fix("nowhere").touch("z1"), 0.0) == SetupErrorKind::bad_argument);  // before any work
  CHECK(kind(Scene().touch("z1"), 0.01) == SetupErrorKind::unconstrained);
  CHECK(kind(Scene().fix("nowhere").touch("z1"), 0.01) == SetupErrorKind::unknown_group);
}

TEST_CASE("errors of a tissue use the node numbers and positions of the given mesh", "[haptic][soft]") {
  Mesh<Tet4> mesh = box_tet4({0.02, 0.02, 0.02}, {2, 2, 2});
  for (Vector3& x : mesh.positions) x += Vector3(3.0, -2.0, 0.0);
  mesh.positions.insert(mesh.positions.begin(), Vector3(3.0, -2.0, 1.0));  // an orphan node, which is dropped
  for (auto& e : mesh.elements)
    for (NodeId& i : e) ++i;
  mesh.groups = {};
  const auto refused = [&](const Scene& scene, const NeoHookean& material, double step = 0.01) {
    return test::refusal([&] { Soft<NeoHookean>(mesh, scene, material, {}, with_step(step)); });
  };
  const NeoHookean material{5e3, 0.45, 1000.0};
  const std::vector<NodeId> edge{1, 10, 19}, bottom{1, 2, 3, 4, 5, 6, 7, 8, 9};
  const SetupProblem movable = refused(Scene().fix(edge).touch("surface"), material);
  CHECK_THAT(movable.what, test::contains("through (3, -2, 0.01)"));
  CHECK(movable.ids.front() == 1);
  const std::vector<NodeId> one{5};
  const SetupProblem twice = refused(Scene().fix(bottom).prescribe(one, {1e-3, 0.0, 0.0}).touch("surface"), material);
  CHECK(to_string(twice.kind) == "conflicting_conditions");
  CHECK(twice.ids == std::vector<std::int64_t>{5});
  const SetupProblem light = refused(Scene().fix(bottom).touch("surface"), {5e3, 0.45, 0.0});
  CHECK(to_string(light.kind) == "bad_density");
  REQUIRE(!light.ids.empty());
  CHECK(light.ids_of != SetupIds::others);
}

TEST_CASE("a tissue without contact reports no status flag", "[haptic][soft]") {
  for (const double g : {0.0, 9.81}) {
    Soft<NeoHookean> tissue(pad(), pad_scene().gravity({0.0, 0.0, -g}), NeoHookean{5e3, 0.45, 1000.0}, {},
                            with_step(0.01));
    for (int k = 0; k < 10; ++k) {
      tissue.advance();
      CHECK(tissue.begin_tick().ok());
      tissue.end_tick({});
    }
  }
}

TEST_CASE("forces that are not finite are dropped and flagged", "[haptic][soft][extreme]") {
  Soft<NeoHookean> tissue(pad(), pad_scene(), NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.01));
  tissue.advance();
  const double none = std::numeric_limits<double>::quiet_NaN();
  const std::array forces{VertexForce{24, {0.0, 0.0, -0.01}}, VertexForce{25, {none, 0.0, 0.0}},
                          VertexForce{26, {0.0, infinity, 0.0}}};
  tissue.end_tick(forces);
  CHECK(tissue.begin_tick().has(StatusFlag::non_finite_force));
  tissue.advance();
  CHECK(tissue.motion().displacement().allFinite());
  CHECK(tissue.motion().displacement().norm() > 0.0);
  tissue.end_tick({});
  CHECK_FALSE(tissue.begin_tick().has(StatusFlag::non_finite_force));
}

TEST_CASE("the compliance is that of the settled body", "[haptic][soft]") {
  const Scene squeezed = Scene().prescribe("x0", {0.006, 0.0, 0.0}).prescribe("x1", {-0.006, 0.0, 0.0}).touch("z1");
  Soft<NeoHookean> tissue(pad(), squeezed, NeoHookean{5e3, 0.45, 1000.0}, {}, with_step(0.01));
  ImplicitDynamics same(
      make_deformable_body(make_hyperelastic_body(pad(), std::vector<NeoHookean>{{5e3, 0.45, 1000.0}}), squeezed), {});
  same.set_state(tissue.motion().displacement(), VectorX::Zero(tissue.motion().displacement().size()));
  REQUIRE(same.prepare_response(0.01));
  tissue.begin_tick();
  VectorX force = VectorX::Zero(same.displacement().size()), u(force.size());
  for (const int j : {16, 24, 30}) {
    const Index node = tissue.touchable_nodes()[static_cast<std::size_t>(j)];
    force[3 * node + 2] = 1.0;
    same.respond(force, u);
    force[3 * node + 2] = 0.0;
    const Vector3 expected = u.segment<3>(3 * node), found = tissue.compliance(j, j).col(2);
    CHECK((found - expected).norm() <= 1e-9 * expected.norm());
  }
}

TEST_CASE("a viscoelastic tissue under a constant indentation relaxes to the slow equilibrium for any step",
          "[haptic][soft][viscous]") {
  const NeoHookean fast{5e3, 0.45, 1000.0};
  const Viscoelastic<NeoHookean, 1> material{fast, {{{0.6, 0.3}}}, Relaxation::whole_stress};
  std::vector<double> early, late;
  for (const double h : {0.02, 0.01, 0.005}) {
    Soft<Viscoelastic<NeoHookean, 1>> tissue(pad(), pad_scene(), material, {}, with_step(h));
    early.push_back(press(tissue, 500, ramp).force[2]);
    const SoftSession s = press(tissue, 4000, [](double) { return ramp(1.0); });
    late.push_back(s.force[2]);
    CHECK((s.status.ok() || s.status == StatusFlag::coarse_contact));
  }
  Soft<NeoHookean> slow(pad(), pad_scene(), NeoHookean{0.4 * 5e3, 0.45, 1000.0}, {}, with_step(0.01));
  const double relaxed = press(slow, 3000, ramp, 0.0, on_facets()).force[2];
  for (const double f : late) CHECK_THAT(f, WithinRel(relaxed, 2e-3));
  for (const double f : early) {
    CHECK_THAT(f, WithinRel(early.back(), 0.02));
    CHECK(f > 1.2 * relaxed);
  }
}

TEST_CASE("viscoelastic tissue at small strain relaxes, too", "[haptic][soft][viscous]") {
  const LinearElastic fast{5e3, 0.45, 1000.0};
  const Viscoelastic<LinearElastic, 1> material{fast, {{{0.6, 0.3}}}, Relaxation::whole_stress};
  Soft<Viscoelastic<LinearElastic, 1>> tissue(pad(), pad_scene(), material, {}, with_step(0.01));
  Soft<LinearElastic> elastic(pad(), pad_scene(), fast, {}, with_step(0.01));
  const auto slight = [](double t) { return std::min(0.001, 0.05 * t); };
  const double at_first = press(tissue, 60, slight).force[2],
               unrelaxed = press(elastic, 2000, slight, 0.0, on_facets()).force[2];
  const double at_last = press(tissue, 4000, [](double) { return 0.001; }).force[2];
  CHECK(at_first > 0.8 * unrelaxed);
  Soft<LinearElastic> slow(pad(), pad_scene(), LinearElastic{0.4 * 5e3, 0.45, 1000.0}, {}, with_step(0.01));
  CHECK_THAT(at_last, WithinRel(press(slow, 2000, slight, 0.0, on_facets()).force[2], 5e-3));
}
