// Static equilibrium at large deformation.
#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/equilibrium.hpp>

#include "catch.hpp"
#include "orphan_in_front.hpp"
#include "refused.hpp"

#include <numbers>

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

/// A slender column, fixed at the bottom, with a dead load on its free top; no imperfection.
struct Column {
  static constexpr double modulus = 1e6, length = 0.3, thickness = 0.01, width = 0.015;  // [Pa], [m]
  static constexpr double bending = modulus * width * thickness * thickness * thickness / 12.0;
  static constexpr double euler = std::numbers::pi * std::numbers::pi * bending / (4.0 * length * length);  // [N]

  template <Element E>
  static Equilibrium loaded(Mesh<E> mesh, double load) {
    return Equilibrium(make_hyperelastic_body(std::move(mesh), std::vector<NeoHookean>{{modulus, 0.0, 1000.0}}),
                       Scene().fix("z0").traction("z1", {0.0, 0.0, -load / (thickness * width)}));
  }
  /// Sideways displacement of the upper end, the mean of its corners, which are the last nodes of the linear mesh.
  static double sideways(const Equilibrium& body, Index linear_nodes, Index corners) {
    Vector3 sum = Vector3::Zero();
    for (Index i = linear_nodes - corners; i < linear_nodes; ++i) sum += body.displacement().segment<3>(3 * i);
    return sum.head<2>().norm() / static_cast<double>(corners);
  }
  /// The same of the elastica, for a load relative to Euler's: K(p) = pi/2 sqrt(load), 2 p / K (Timoshenko and Gere,
  /// Theory of Elastic Stability, 2.7).
  static double elastica(double load) {
    const double wanted = 0.5 * std::numbers::pi * std::sqrt(load);
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k) (std::comp_ellint_1(0.5 * (low + high)) < wanted ? low : high) = 0.5 * (low + high);
    return length * 2.0 * low / wanted;
  }
};

/// Half of a shallow truss of two bars: a bar with hinges at both ends, one fixed, the other one 10 mm higher and 100
/// mm away, where it can only move up and down. `load` presses it down [N].
struct Truss {
  static constexpr double modulus = 1e6, span = 0.1, thickness = 0.01, width = 0.01, rise = 0.01;
  Mesh<Hex20> mesh = mesh_of();
  std::vector<NodeId> top;

  static Mesh<Hex20> mesh_of() {
    Mesh<Hex8> bar = box_hex8({span, width, thickness}, {10, 1, 2});
    for (Vector3& x : bar.positions) x.z() += rise * x.x() / span;
    return promote<Hex20>(bar);
  }
  Equilibrium loaded(double load) {
    std::vector<NodeId> bottom;
    for (Index i = 0; i < mesh.node_count(); ++i) {
      const Vector3& x = mesh.position(i);
      if (std::abs(x.z() - 0.5 * thickness - rise * x.x() / span) > 1e-6) continue;  // not on the axis
      if (x.x() < 1e-6) bottom.push_back(static_cast<NodeId>(i));
      if (x.x() > span - 1e-6) top.push_back(static_cast<NodeId>(i));
    }
    Scene scene;
    scene.fix(bottom).prescribe(top, Components{0.0, 0.0, std::nullopt}).point_load(top, {0.0, 0.0, -load});
    return Equilibrium(make_hyperelastic_body(mesh, std::vector<NeoHookean>{{modulus, 0.0, 1000.0}}), scene);
  }
  /// Height of the upper hinge above the lower one, relative to that at rest.
  double height(const Equilibrium& body) const { return 1.0 + body.displacement()[3 * Index{top[0]} + 2] / rise; }
  /// Load of the shallow truss at a height: EA (rise / length)^3 (y - y^3) / 2.
  static double load_at(double y) {
    const double slope = rise / span;
    return 0.5 * modulus * thickness * width * slope * slope * slope * (y - y * y * y);
  }
};

}  // namespace

TEST_CASE("a column loaded beyond Euler's load buckles into the elastica", "[model][equilibrium][buckling]") {
  const Mesh<Hex8> bricks = box_hex8({Column::thickness, Column::width, Column::length}, {1, 1, 15});
  for (const double load : {0.95, 1.05, 1.2, 2.0}) {
    Equilibrium body = Column::loaded(promote<Hex20>(bricks), load * Column::euler);
    const EquilibriumReport report = body.solve();
    INFO("load " << load << ": " << describe(report));
    CHECK(report.converged);
    CHECK(report.stable);
    CHECK(report.iterations <= 100);
    const double sideways = Column::sideways(body, bricks.node_count(), 4);
    if (load < 1.0)
      CHECK(sideways <= 1e-9 * Column::length);
    else
      CHECK_THAT(sideways, WithinRel(Column::elastica(load), 0.02));
  }
}

TEST_CASE("a column of tetrahedra buckles too, and straightens when it is unloaded", "[model][equilibrium][buckling]") {
  const Mesh<Tet4> tets = box_tet4({Column::thickness, Column::width, Column::length}, {1, 2, 12}, BoxSplit::six);
  Equilibrium body = Column::loaded(promote<Tet10>(tets), 1.1 * Column::euler);
  const EquilibriumReport report = body.solve();
  INFO(describe(report));
  CHECK(report.converged);
  CHECK(report.stable);
  CHECK(report.iterations <= 100);
  CHECK_THAT(Column::sideways(body, tets.node_count(), 6), WithinRel(Column::elastica(1.1), 0.05));
  body.set_load(VectorX::Zero(body.displacement().size()));
  REQUIRE(body.step(0.0).converged);
  CHECK(Column::sideways(body, tets.node_count(), 6) <= 1e-9 * Column::length);
}

TEST_CASE("a body solved again has the same equilibrium to the last bit", "[model][equilibrium][buckling]") {
  const Mesh<Tet4> tets = box_tet4({Column::thickness, Column::width, Column::length}, {1, 2, 12}, BoxSplit::six);
  Equilibrium body = Column::loaded(promote<Tet10>(tets), 1.1 * Column::euler);
  REQUIRE(body.solve().converged);
  const VectorX first = body.displacement();
  REQUIRE(body.solve().converged);
  CHECK(body.displacement() == first);
}

TEST_CASE("a shallow truss snaps through beyond its limit load, and stays there", "[model][equilibrium][buckling]") {
  const double limit = Truss::load_at(std::sqrt(1.0 / 3.0));
  Truss stiff;
  Equilibrium small = stiff.loaded(1e-3 * limit);
  REQUIRE(small.solve().converged);
  const double share = 1e-3 * limit / Truss::load_at(stiff.height(small));  // of the axial stiffness: hinges yield
  CHECK(share > 0.8);
  CHECK(share < 1.0);
  for (const double load : {0.7, 1.3, 3.0}) {
    Truss truss;
    Equilibrium body = truss.loaded(load * limit);
    const EquilibriumReport report = body.solve();
    INFO("load " << load << ": " << describe(report));
    CHECK(report.converged);
    CHECK(report.stable);
    CHECK(report.iterations <= 100);
    const double y = truss.height(body);
    CHECK((y > 0.0) == (load < 1.0));
    CHECK_THAT(share * Truss::load_at(y), WithinRel(load * limit, 0.03));
    body.set_load(VectorX::Zero(body.displacement().size()));
    const EquilibriumReport unloaded = body.step(0.0);
    CHECK(unloaded.converged);
    CHECK(unloaded.stable);
    CHECK_THAT(truss.height(body), WithinRel(load < 1.0 ? 1.0 : -1.0, 1e-2));
  }
}

TEST_CASE("a dead load that a material cannot bear is reported", "[model][equilibrium][buckling]") {
  // Confined St. Venant-Kirchhoff: P(s) = E s (s^2 - 1) / 2 at nu = 0, largest at s = 1 / sqrt 3
  const double modulus = 1e4, largest = modulus / std::sqrt(27.0);
  const Components no_x{0.0, std::nullopt, std::nullopt}, no_y{std::nullopt, 0.0, std::nullopt};
  for (const double load : {0.9, 1.3}) {
    Equilibrium body(
        make_hyperelastic_body(box_tet4(size, {2, 2, 4}), std::vector<StVenantKirchhoff>{{modulus, 0.0, 1.0}}),
        Scene()
            .fix("z0")
            .traction("z1", {0.0, 0.0, -load * largest})
            .prescribe("x0", no_x)
            .prescribe("x1", no_x)
            .prescribe("y0", no_y)
            .prescribe("y1", no_y));
    const EquilibriumReport report = body.solve();
    INFO("load " << load << ": " << describe(report));
    CHECK(report.converged == (load < 1.0));
    CHECK(body.displacement().allFinite());
    if (load < 1.0) continue;
    CHECK(report.fraction > 0.9 / load);
    CHECK(report.fraction <= 1.0 / load + 1e-9);
  }
}

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
  detail::TangentSolver solver(detail::block_pattern(mesh), conditions, mesh.positions, {});
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
