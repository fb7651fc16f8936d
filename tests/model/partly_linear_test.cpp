// Tissue at large strain near the tools, linear elsewhere, against tissue at large strain everywhere.
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include "model/one_session.hpp"

using namespace palpate;

namespace {

using testing::Random;
using Solver = Implicit<QuasiNewton<>>;

const NeoHookean neo_hookean_liver{5e3, 0.45, 1000.0};

template <class E = Smoothed<Tet4>>
Mesh<E> slab() {
  if constexpr (E::nodes == 10)
    return promote<E>(box_tet4({0.12, 0.12, 0.06}, {4, 4, 2}, BoxSplit::six));
  else
    return copy_mesh<E>(box_tet4({0.12, 0.12, 0.06}, {8, 8, 4}, BoxSplit::six));
}
/// Fixed at the bottom; touched in the middle of the top.
Scene touched_slab() {
  return Scene().fix("z0").touch(where::box({0.025, 0.025, 0.059}, {0.095, 0.095, 0.061}));
}
QuasiNewtonParameters exact_steps(double within) {
  return {
      .settle = false, .inertia = false, .maximum_iterations = 200, .tolerance = 1e-11, .large_strain_within = within};
}
template <class E>
std::unique_ptr<TissueMotion> motion_of(const Mesh<E>& mesh, const Scene& scene, const QuasiNewtonParameters& p) {
  return SolverTraits<Solver>::make_motion(make_hyperelastic_body(mesh, std::vector{neo_hookean_liver}), scene, p, {})
      .motion;
}
template <class E>
std::vector<NodeId> touched_nodes(const Mesh<E>& mesh, const Scene& scene) {
  return detail::resolve_touchable(mesh_ref(mesh), extract_boundary<E>(mesh), scene).nodes;
}
/// A push on the touched nodes, and a small force on all others.
template <class E>
VectorX load_of(const Mesh<E>& mesh, const Scene& scene, const Vector3& push) {
  Random random(11);
  VectorX load(3 * mesh.node_count());
  for (double& f : load) f = 1e-4 * push.norm() * random.uniform(-1.0, 1.0);
  const auto touched = touched_nodes(mesh, scene);
  for (const NodeId i : touched) add_node_vector(load, Index{i}, push / static_cast<double>(touched.size()));
  return load;
}
/// Displacement at rest under a load.
VectorX rest_under(TissueMotion& motion, const VectorX& load) {
  motion.set_load(load);
  MotionStep done;
  for (int k = 0; k < 5; ++k) done = motion.step(0.016);
  CHECK(done.taken);
  CHECK(done.relative_residual <= 1e-5);  // rounding of the energy ends steps, and depends on the processor
  VectorX u = motion.displacement();
  motion.complete(u);
  return u;
}

}  // namespace

TEST_CASE("a body is divided by the distance along its edges", "[model][partly_linear]") {
  const auto mesh = slab();
  const auto touched = touched_nodes(mesh, touched_slab());
  const detail::NodeElements around(mesh);
  std::size_t last = 0;
  for (const double within : {0.0, 0.015, 0.03, 0.045, 1.0}) {
    const detail::BodyParts parts = detail::divide_body(mesh_ref(mesh), touched, within);
    CHECK(parts.near_part.elements.size() > last);
    last = parts.near_part.elements.size();
    CHECK(parts.near_part.elements.size() + parts.far_part.elements.size() == mesh.elements.size());
    CHECK(parts.near_part.nodes.size() + parts.far_part.nodes.size() ==
          mesh.positions.size() + parts.interface_nodes.size());
    for (const NodeId i : touched)
      for (const NodeId e : around.of(i)) CHECK(std::ranges::binary_search(parts.near_part.elements, Index{e}));
    for (const NodeId i : parts.interface_nodes) CHECK((parts.near_part.local(i) >= 0 && parts.far_part.local(i) >= 0));
    for (const Index e : parts.far_part.elements)
      for (const NodeId i : mesh.elements[static_cast<std::size_t>(e)])
        for (const NodeId t : touched) {
          const double straight = (mesh.position(Index{i}) - mesh.position(Index{t})).norm();
          CHECK((straight > within || parts.near_part.local(i) >= 0));  // a path is not shorter
        }
  }
  CHECK(detail::divide_body(mesh_ref(mesh), touched, 1.0).far_part.elements.empty());
}

TEMPLATE_TEST_CASE("at small displacement linear surroundings change nothing", "[model][partly_linear]", Tet4, Tet10) {
  const auto mesh = slab<TestType>();
  const Scene scene = touched_slab();
  const VectorX load = load_of(mesh, scene, 1e-5 * Vector3(1.0, 0.5, -2.0));
  VectorX raised = VectorX::Zero(load.size());  // supports that move, of both parts or of the far one
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i).z() < 1e-9) set_node_vector(raised, i, 1e-7 * mesh.position(i));
  const auto whole = motion_of(mesh, scene, exact_steps(infinity));
  const VectorX pressed = rest_under(*whole, load);
  whole->set_prescribed(raised);
  const VectorX moved = rest_under(*whole, load);
  CHECK((moved - pressed).norm() > 1e-3 * pressed.norm());
  for (const double within : {0.0, 0.02, 0.045}) {
    INFO("within " << within);
    const auto partly = motion_of(mesh, scene, exact_steps(within));
    CHECK(dynamic_cast<const detail::PartlyLinearMotion*>(partly.get()) != nullptr);
    CHECK((rest_under(*partly, load) - pressed).norm() <= 1e-5 * pressed.norm());
    partly->set_prescribed(raised);
    CHECK((rest_under(*partly, load) - moved).norm() <= 1e-5 * moved.norm());
  }
}

TEMPLATE_TEST_CASE("the error of linear surroundings falls with their distance", "[model][partly_linear]", Tet4,
                   Smoothed<Tet4>) {
  const auto mesh = slab<TestType>();
  const Scene scene = touched_slab();
  const VectorX load = load_of(mesh, scene, {1.0, 0.0, -6.0});
  const VectorX exact = rest_under(*motion_of(mesh, scene, exact_steps(infinity)), load);
  CHECK(exact.cwiseAbs().maxCoeff() > 0.004);
  double last = 0.1;
  for (const double within : {0.015, 0.03, 0.045}) {
    const double error = (rest_under(*motion_of(mesh, scene, exact_steps(within)), load) - exact).norm() / exact.norm();
    INFO("within " << within << ", error " << error);
    CHECK(error < last);
    last = error;
  }
  CHECK(last < (detail::HasSmoothedStrain<TestType> ? 0.02 : 0.005));  // smoothing ends at the interface
}

TEST_CASE("the force of a surrounded part is the derivative of its energy", "[model][partly_linear]") {
  const auto mesh = slab<Tet4>();
  const detail::BodyParts parts = detail::divide_body(mesh_ref(mesh), touched_nodes(mesh, touched_slab()), 0.01);
  const auto body = make_hyperelastic_body(mesh, std::vector{neo_hookean_liver});
  const auto far = detail::part_of(body.rest, parts.far_part);
  detail::LinearSurroundings surroundings(
      assemble_stiffness<Tet4>(far, {}),
      detail::conditions_of(parts.far_part, resolve_essential(mesh, extract_boundary<Tet4>(mesh), touched_slab())),
      far.mesh.positions, parts.interface_in(parts.far_part), {});
  const MatrixX& s = surroundings.stiffness();
  CHECK((s - s.transpose()).norm() == 0.0);
  detail::SurroundedForces forces(
      detail::make_energy_forces<double>(detail::part_of(body, parts.near_part), SetupLimits{}), s,
      detail::dofs_in(parts.near_part, parts.far_part, surroundings.kept()));
  Random random(5);
  VectorX u(forces.size()), f(u.size()), unused(u.size()), direction(u.size());
  for (double& x : u) x = random.uniform(-5e-4, 5e-4);
  for (double& x : direction) x = random.uniform(-1.0, 1.0);
  DeformationReport report;
  forces.evaluate(u, f, report);
  const double h = 1e-6, up = forces.evaluate(u + h * direction, unused, report),
               down = forces.evaluate(u - h * direction, unused, report);
  CHECK(f.dot(direction) == Catch::Approx((up - down) / (2.0 * h)).epsilon(1e-6));
}

TEST_CASE("a tool feels the same with linear surroundings", "[model][partly_linear][haptic]") {
  using Model = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<float>>>;
  const Scene scene = Scene().fix("z0").touch(where::box({0.02, 0.02, 0.029}, {0.04, 0.04, 0.031}));
  const auto force = [&](double within) {
    Model model(one_session::block(), scene, neo_hookean_liver, {}, {.inertia = false, .large_strain_within = within});
    HapticServo servo(model, SphereTool{one_session::radius}, one_session::stiff_device());
    return one_session::press(model, servo, 0.006, 800).back();
  };
  const Vector3 exact = force(infinity), near = force(0.01);
  CHECK(exact[2] > 0.1);
  CHECK((near - exact).norm() <= 0.02 * exact.norm());
}

TEST_CASE("a step with linear surroundings allocates nothing and reports their displacement",
          "[model][partly_linear][allocation][extreme]") {
  const auto mesh = copy_mesh<Smoothed<Tet4>>(box_tet4({0.2, 0.02, 0.02}, {20, 2, 2}, BoxSplit::six));
  const Scene scene = Scene().fix("x0").touch("x1");  // a cantilever: its far part rotates
  const auto motion = motion_of(mesh, scene, {.settle = false, .inertia = false, .large_strain_within = 0.02});
  for (const double push : {1e-3, 0.05}) {
    VectorX load = VectorX::Zero(3 * mesh.node_count());
    add_node_vector(load, mesh.node_count() - 1, {0.0, 0.0, -push});
    MotionStep done;
    const testing::AllocationScope scope;
    motion->set_load(load);
    for (int k = 0; k < 20; ++k) done = motion->step(0.016);
    CHECK(scope.allocations() == 0);
    CHECK(done.taken);
    CHECK(done.status.has(StatusFlag::large_displacement) == (push > 0.01));
  }
}

TEST_CASE("a far part that hangs on the interface and turns with it is reported", "[model][partly_linear][extreme]") {
  const auto mesh = copy_mesh<Smoothed<Tet4>>(box_tet4({0.2, 0.02, 0.02}, {20, 2, 2}, BoxSplit::six));
  Scene scene = Scene().fix("x0").touch(where::box({0.0, 0.0, 0.019}, {0.05, 0.02, 0.021}));
  const auto motion = motion_of(mesh, scene, {.settle = false, .inertia = false, .large_strain_within = 0.0});
  for (const double push : {0.005, 0.1}) {
    VectorX load = VectorX::Zero(3 * mesh.node_count());
    for (Index i = 0; i < mesh.node_count(); ++i)
      if (std::abs(mesh.position(i).x() - 0.04) < 1e-9) add_node_vector(load, i, {0.0, 0.0, -push / 9.0});
    motion->set_load(load);
    MotionStep done;
    for (int k = 0; k < 20; ++k) done = motion->step(0.016);
    VectorX u = motion->displacement();
    motion->complete(u);
    INFO("end moves " << u[u.size() - 1]);
    CHECK(done.status.has(StatusFlag::large_displacement) == (push > 0.01));
    CHECK((std::abs(u[u.size() - 1]) > 0.1 * 0.2) == (push > 0.01));
  }
}

TEST_CASE("values of free dofs have no effect on prescribed displacements", "[model][partly_linear]") {
  const auto mesh = slab();
  const Scene scene = touched_slab();
  VectorX raised = VectorX::Zero(3 * mesh.node_count()), everywhere_set = raised;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    set_node_vector(everywhere_set, i, 1e-3 * mesh.position(i));
    if (mesh.position(i).z() < 1e-9) set_node_vector(raised, i, node_vector(everywhere_set, i));
  }
  const auto motion = motion_of(mesh, scene, exact_steps(0.02));
  motion->set_prescribed(raised);
  const VectorX expected = rest_under(*motion, VectorX::Zero(raised.size()));
  motion->set_prescribed(everywhere_set);
  CHECK((rest_under(*motion, VectorX::Zero(raised.size())) - expected).norm() <= 1e-9 * expected.norm());
}

TEST_CASE("a refusal of a part names the nodes of the body", "[model][partly_linear][extreme]") {
  auto mesh = slab();
  const auto touched = touched_nodes(mesh, touched_slab());
  const detail::BodyParts parts = detail::divide_body(mesh_ref(mesh), touched, 0.02);
  mesh.region_names = {"tissue", "light"};
  mesh.regions.assign(mesh.elements.size(), 0);
  for (const Index e : parts.near_part.elements) mesh.regions[static_cast<std::size_t>(e)] = 1;
  NeoHookean light = neo_hookean_liver;
  light.density = 0.0;
  try {
    SolverTraits<Solver>::make_motion(make_hyperelastic_body(mesh, std::vector{neo_hookean_liver, light}),
                                      touched_slab(), exact_steps(0.02), {});
    FAIL("not refused");
  } catch (const SetupError& e) {
    CHECK(e.kind() == SetupErrorKind::bad_density);
    REQUIRE(!e.problem().ids.empty());
    const auto node = static_cast<NodeId>(e.problem().ids[0]);
    CHECK(parts.near_part.local(node) >= 0);
    CHECK(parts.far_part.local(node) < 0);
  }
}

TEST_CASE("parts that cannot be linear are refused", "[model][partly_linear][extreme]") {
  const auto mesh = slab();
  const auto refusal = [&](const QuasiNewtonParameters& p) {
    return test::refusal_kind([&] { motion_of(mesh, touched_slab(), p); });
  };
  CHECK(refusal({.inertia = true, .large_strain_within = 0.01}) == "unsupported");
  CHECK(refusal({.inertia = false, .large_strain_within = -0.01}) == "bad_argument");
  CHECK(refusal({.inertia = false, .large_strain_within = std::numeric_limits<double>::quiet_NaN()}) == "bad_argument");
  using Law = Viscoelastic<NeoHookean, 1>;
  const Law law{.base = neo_hookean_liver, .terms = {{{0.5, 0.1}}}};
  CHECK(test::refusal_kind([&] {
          SolverTraits<Solver>::make_motion(make_hyperelastic_body(slab<Tet10>(), std::vector{law}), touched_slab(),
                                            {.inertia = false, .large_strain_within = 0.01}, {});
        }) == "unsupported");
}
