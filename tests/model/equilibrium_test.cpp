// Static equilibrium at large deformation.
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/equilibrium.hpp>

#include "catch.hpp"
#include "orphan_in_front.hpp"
#include "refused.hpp"

using namespace palpate;
using Catch::Matchers::WithinRel;

namespace {

const Vector3 size(0.04, 0.04, 0.08);

template <class M = NeoHookean>
Equilibrium pillar(const Scene& scene, double youngs_modulus = 5e3) {
  return Equilibrium(make_hyperelastic_body(box_tet4(size, {3, 3, 6}), std::vector<M>{{youngs_modulus, 0.45, 1000.0}}),
                     scene);
}

double sum_along(const VectorX& forces, int axis) {
  return Eigen::Map<const Eigen::Matrix3Xd>(forces.data(), 3, forces.size() / 3).row(axis).sum();
}

}  // namespace

TEST_CASE("a prescribed affine boundary gives the affine state inside", "[model][equilibrium]") {
  const Mesh<Tet4> mesh = box_tet4(size, {3, 3, 4});
  Matrix3 a;
  a << 1.3, 0.4, 0.0, 0.1, 0.9, 0.1, 0.0, -0.2, 0.8;
  Scene scene;
  for (const NodeId i : nodes_of(extract_boundary<Tet4>(mesh))) {
    const Vector3 u = a * mesh.position(i) - mesh.position(i);
    scene.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  Equilibrium body(make_hyperelastic_body(mesh, std::vector<NeoHookean>{{5e3, 0.45, 0.0}}), scene);
  const EquilibriumReport report = body.solve();
  CHECK(report.converged);
  CHECK(report.stable);
  for (Index i = 0; i < mesh.node_count(); ++i)
    CHECK((body.displacement().segment<3>(3 * i) - (a * mesh.position(i) - mesh.position(i))).norm() <= 1e-12);
}

TEST_CASE("loads, reactions and internal forces balance", "[model][equilibrium]") {
  Equilibrium body = pillar(Scene().fix("z0").gravity({2.0, 0.0, -9.81}).point_load("z1", {0.01, 0.02, -0.03}));
  const EquilibriumReport report = body.solve();
  REQUIRE(report.converged);
  CHECK(report.relative_residual <= 1e-10);
  CHECK(report.iterations <= 10);
  const double mass = 1000.0 * size.prod();
  const VectorX r = body.reactions();
  CHECK_THAT(sum_along(r, 0), WithinRel(-2.0 * mass - 0.01, 1e-9));
  CHECK_THAT(sum_along(r, 1), WithinRel(-0.02, 1e-9));
  CHECK_THAT(sum_along(r, 2), WithinRel(9.81 * mass + 0.03, 1e-9));
}

TEST_CASE("small loads give the result of linear elasticity, and the difference is of second order",
          "[model][equilibrium]") {
  const auto tip = [](double g) {
    Equilibrium body = pillar(Scene().fix("z0").gravity({g, 0.0, 0.0}));
    REQUIRE(body.solve().converged);
    return (body.displacement() / g).eval();
  };
  const VectorX linear = tip(1e-3);
  const double at_one = (tip(1.0) - linear).norm(), at_two = (tip(2.0) - linear).norm();
  CHECK(at_one <= 0.05 * linear.norm());
  CHECK(at_two / at_one > 1.5);
  CHECK(at_two / at_one < 4.5);
}

TEST_CASE("the number of load steps does not change the answer", "[model][equilibrium]") {
  const Scene scene = Scene().fix("z0").prescribe("z1", {0.01, 0.0, -0.02});
  Equilibrium one = pillar(scene), many = pillar(scene);
  const EquilibriumReport a = one.solve(), b = many.solve({.load_steps = 7});
  REQUIRE((a.converged && b.converged));
  CHECK(b.load_steps > a.load_steps);
  CHECK((one.displacement() - many.displacement()).norm() <= 1e-8 * one.displacement().norm());
}

TEST_CASE("a pillar compressed beyond its buckling load settles in a stable state", "[model][equilibrium]") {
  Equilibrium body = pillar(Scene().fix("z0").prescribe("z1", {0.0, 0.0, -0.036}));
  const EquilibriumReport report = body.solve();
  CHECK(report.converged);
  CHECK(report.stable);
  Equilibrium again = pillar(Scene().fix("z0").prescribe("z1", {0.0, 0.0, -0.036}));
  again.solve();
  CHECK(again.displacement() == body.displacement());  // always in the same direction
}

TEST_CASE("a load without equilibrium is reported, with the most deformed element", "[model][equilibrium]") {
  const Components no_x{0.0, std::nullopt, std::nullopt}, no_y{std::nullopt, 0.0, std::nullopt};
  Equilibrium body = pillar<NeoHookeanLogarithmic>(  // confined, with the top prescribed below the bottom
      Scene()
          .fix("z0")
          .prescribe("z1", {0.0, 0.0, -0.0801})
          .prescribe("x0", no_x)
          .prescribe("x1", no_x)
          .prescribe("y0", no_y)
          .prescribe("y1", no_y));
  const EquilibriumReport report = body.solve();
  CHECK_FALSE(report.converged);
  CHECK(report.fraction > 0.3);
  CHECK(report.fraction < 1.0);
  CHECK(report.deformation.worst_element >= 0);
  CHECK(report.deformation.smallest_volume_ratio > 0.0);
  CHECK(body.displacement().allFinite());
  CHECK_THAT(describe(report), test::contains("no equilibrium was found beyond"));
}

TEST_CASE("equilibrium refuses bodies that can move rigidly, and initial strains", "[model][equilibrium]") {
  const auto kind = [](const Scene& scene) {
    try {
      pillar(scene);
    } catch (const SetupError& error) {
      return error.kind();
    }
    return SetupErrorKind::cancelled;
  };
  CHECK(kind(Scene().prescribe("z0", Components{std::nullopt, std::nullopt, 0.0})) == SetupErrorKind::unconstrained);
  CHECK(kind(Scene().fix("z0").expand(std::string(everywhere), 0.01)) == SetupErrorKind::unsupported);
}

TEST_CASE("equilibrium refuses the meshes that a linear model refuses, with the same ids", "[model][equilibrium]") {
  const Scene scene = Scene().fix("z0").touch("z1");
  const auto good = [] { return test::with_orphan_in_front(box_tet4(size, {2, 2, 3}), Vector3(1, 1, 1)); };
  const NeoHookean rubber{5e3, 0.4, 1000.0};
  const LinearElastic linear{5e3, 0.4, 1000.0};
  const auto check = [&](const char* what, const Mesh<Tet4>& mesh, const Scene& constrained) {
    INFO(what);
    const SetupProblem expected =
        test::refusal([&] { HapticFEModel<Tet4, LinearElastic, SparseCholesky>(mesh, constrained, linear); });
    for (const SetupProblem& p : {test::refusal([&] { Equilibrium(mesh, constrained, rubber); }),
                                  test::refusal([&] { Equilibrium(mesh, constrained, linear); })}) {
      CHECK(to_string(p.kind) == to_string(expected.kind));
      CHECK(p.what == expected.what);
      CHECK(p.ids == expected.ids);
      CHECK(p.ids_of == expected.ids_of);
    }
  };
  const auto edited = [&](auto edit) {
    Mesh<Tet4> mesh = good();
    edit(mesh);
    return mesh;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  check("flat", edited([](auto& m) {
          auto& x = m.positions;
          const auto at = [&](int a) -> Vector3& { return x[static_cast<std::size_t>(m.elements[7][a])]; };
          at(0) = (at(1) + at(2) + at(3)) / 3.0;
        }),
        scene);
  check("twin", edited([](auto& m) { m.positions[9] = m.positions[10]; }), scene);
  check("repeated node", edited([](auto& m) { m.elements[9][1] = m.elements[9][0]; }), scene);
  check("repeated element", edited([](auto& m) { m.elements.push_back(m.elements[5]); }), scene);
  check("not finite", edited([&](auto& m) { m.positions[5][1] = none; }), scene);
  check("outside", edited([](auto& m) { m.elements[3][2] = 4711; }), scene);
  check("inverted", edited([](auto& m) { std::swap(m.elements[2][0], m.elements[2][1]); }), scene);
  check("empty", edited([](auto& m) { m.elements.clear(); }), scene);
  check("free", good(), Scene().fix(std::vector<NodeId>{1, 2}).touch("z1"));
  check("two values", good(), Scene().fix("z0").prescribe(std::vector<NodeId>{1}, {1.0, 0.0, 0.0}));
  check("unknown group", good(), Scene().fix("nowhere"));
}

TEST_CASE("a mesh as given and a body of the admitted mesh have the same equilibrium", "[model][equilibrium]") {
  Mesh<Tet4> mesh = box_tet4(size, {2, 2, 3});
  for (Vector3& x : mesh.positions) x += Vector3(7, -3, 1);
  mesh.positions.emplace_back(0, 0, 0);  // dropped
  const Scene scene = Scene().fix("z0").gravity({2.0, 0.0, -9.81}).point_load("z1", {0.01, 0.02, -0.03});
  const NeoHookean rubber{5e3, 0.4, 1000.0};
  Equilibrium given(mesh, scene, rubber);
  Equilibrium made(make_hyperelastic_body(admit<Tet4>(mesh).mesh, std::vector<NeoHookean>{rubber}), scene);
  REQUIRE((given.solve().converged && made.solve().converged));
  CHECK((given.displacement() - made.displacement()).norm() <= 1e-9 * made.displacement().norm());
  CHECK(given.node_map().size() == mesh.positions.size());
  CHECK(given.node_map().back() == -1);
  CHECK(made.node_map().empty());
  EquilibriumOptions refuse;
  refuse.admission.orphans = Admission::refuse;
  CHECK_REFUSED(SetupErrorKind::orphan_node, Equilibrium(mesh, scene, rubber, refuse));
}

TEST_CASE("the most deformed element is named in the mesh as given", "[model][equilibrium]") {
  Mesh<Tet4> mesh = box_tet4(size, {2, 2, 3});
  const Scene scene = Scene().fix("z0").point_load("z1", {0.0, 0.05, -0.05});
  const NeoHookean rubber{5e3, 0.4, 1000.0};
  EquilibriumOptions drop;
  drop.admission.duplicate_elements = Admission::repair;
  const Index worst = Equilibrium(mesh, scene, rubber).solve().deformation.worst_element;
  REQUIRE(worst > 0);
  mesh.elements.insert(mesh.elements.begin() + 1, mesh.elements[0]);  // dropped: all later ids move
  CHECK(Equilibrium(mesh, scene, rubber, drop).solve().deformation.worst_element == worst + 1);
}

TEST_CASE("invalid solver parameters are refused", "[model][equilibrium]") {
  Equilibrium body = pillar(Scene().fix("z0").gravity({0.0, 0.0, -9.81}));
  const auto kind = [&](const EquilibriumParameters& parameters) {
    try {
      body.solve(parameters);
    } catch (const SetupError& error) {
      return error.kind();
    }
    return SetupErrorKind::cancelled;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, none, 2.0}) CHECK(kind({.smallest_step = bad}) == SetupErrorKind::bad_argument);
  for (const int bad : {0, -3}) {
    CHECK(kind({.load_steps = bad}) == SetupErrorKind::bad_argument);
    CHECK(kind({.newton = {.maximum_iterations = bad}}) == SetupErrorKind::bad_argument);
  }
  CHECK(kind({.newton = {.tolerance = none}}) == SetupErrorKind::bad_argument);
  CHECK(kind({}) == SetupErrorKind::cancelled);
}

TEST_CASE("a tangent that is not positive definite is shifted, within a bound", "[model][equilibrium]") {
  const Mesh<Tet4> mesh = box_tet4(size, {2, 2, 2});
  const auto body = make_hyperelastic_body(mesh, std::vector<NeoHookean>{{5e3, 0.45, 0.0}});
  const auto conditions = resolve_essential(mesh, extract_boundary<Tet4>(mesh), Scene().fix("z0"));
  TangentSolver solver(block_pattern(mesh), conditions, mesh.positions, {});
  const BlockMatrix k = assemble_stiffness<Tet4>(body.rest, {});
  for (const double factor : {1.0, -1.0, -1e-3, -1e3}) {
    solver.matrix().set_zero();
    solver.matrix().add(factor, k);
    REQUIRE(solver.factorise());
    CHECK((solver.shift() > 0.0) == (factor < 0.0));
    CHECK(solver.shift() <= 5.0 * solver.largest_diagonal());
    VectorX r = VectorX::Ones(solver.size()), d(r);
    solver.solve(r, d);
    CHECK(r.dot(d) > 0.0);
  }
  solver.matrix().block(0)(0, 0) = std::numeric_limits<double>::quiet_NaN();
  solver.matrix().block(k.pattern().diagonal(mesh.node_count() - 1))(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(solver.factorise());
}
