// Relaxation, creep and motion of viscoelastic bodies, against closed forms (tests/data/oracle/README.md).
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/LU>

#include <complex>
#include <fstream>
#include <numbers>
#include <sstream>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double share = 0.5, tau = 0.5, applied_strain = 0.01;
using Cube = Viscoelastic<LinearElastic, 1>;

Cube cube_material(Relaxation relaxation) {
  return {LinearElastic{1e4, 0.45, 1000.0}, {{{share, tau}}}, relaxation};
}
std::vector<std::vector<double>> oracle_rows(const std::string& name) {
  std::ifstream file(PALPATE_TEST_DATA "/oracle/K_viscoelastic_cube/" + name);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream in(line);
    rows.emplace_back();
    for (std::string word; std::getline(in, word, ',');) rows.back().push_back(std::stod(word));
  }
  return rows;
}

/// The three load cases of a unit cube in the reference, and its stress.
struct LoadCase {
  const char* name;
  std::size_t column;  // of the table, for whole_stress
};
constexpr LoadCase pulled{"uniaxial_free", 1}, confined{"confined", 2}, sheared{"shear", 3};

template <Element E>
Scene supports_of(const LoadCase& load_case, const Mesh<E>& mesh, double size) {
  const auto along = [](int axis, double u) {
    Components c;
    c[static_cast<std::size_t>(axis)] = u;
    return c;
  };
  Scene scene;
  if (load_case.column == sheared.column) {
    for (const NodeId i : nodes_of(extract_boundary<E>(mesh)))
      scene.prescribe(std::vector<NodeId>{i}, {size * mesh.position(i).y(), 0.0, 0.0});
    return scene;
  }
  scene.prescribe("x0", along(0, 0.0)).prescribe("y0", along(1, 0.0)).prescribe("z0", along(2, 0.0));
  scene.prescribe("x1", along(0, size));
  if (load_case.column == confined.column) scene.prescribe("y1", along(1, 0.0)).prescribe("z1", along(2, 0.0));
  return scene;
}
/// Force in x on the face at x = 1 (for shear y = 1) [N], for a unit cube equal to its stress [Pa].
template <Element E>
double stress_of(const LoadCase& load_case, const Mesh<E>& mesh, const Equilibrium& body) {
  const VectorX r = body.reactions();
  const int axis = load_case.column == sheared.column ? 1 : 0;
  double sum = 0.0;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i)[axis] > 1.0 - 1e-9) sum += r[3 * i];
  return sum;
}

/// Largest relative error over the rows of the table, with `steps` steps between two.
template <Element E>
double relaxation_error(const Mesh<E>& mesh, const LoadCase& load_case, Relaxation relaxation, int steps) {
  Equilibrium body(
      make_constrained_body(make_body(mesh, cube_material(relaxation)), supports_of(load_case, mesh, applied_strain)));
  double time = 0.0, worst = 0.0;
  const auto rows = oracle_rows("closed_form_relaxation.csv");
  REQUIRE(rows.size() == 18);
  for (const auto& row : rows) {
    const int count = row[0] == 0.0 ? 1 : steps;
    for (int k = 0; k < count; ++k) REQUIRE(body.step((row[0] - time) / count).converged);
    time = row[0];
    const double exact = row[load_case.column + (relaxation == Relaxation::deviatoric ? 3 : 0)];
    worst = std::max(worst, std::abs(stress_of(load_case, mesh, body) / exact - 1.0));
  }
  return worst;
}

constexpr double period = 2.0 * std::numbers::pi;

}  // namespace

TEMPLATE_TEST_CASE("a cube under constant strain relaxes as its closed form", "[model][viscous][oracle]", Tet4, Hex8) {
  const auto mesh = [] {
    if constexpr (std::is_same_v<TestType, Tet4>)
      return box_tet4({1, 1, 1}, {2, 2, 2});
    else
      return box_hex8({1, 1, 1}, {2, 2, 2});
  }();
  for (const LoadCase& load_case : {pulled, confined, sheared}) {
    INFO(load_case.name);
    CHECK(relaxation_error(mesh, load_case, Relaxation::whole_stress, 1) <= 1e-9);
    if (load_case.column != pulled.column) CHECK(relaxation_error(mesh, load_case, Relaxation::deviatoric, 1) <= 1e-9);
  }
  // The sides move during deviatoric relaxation: second-order accurate.
  const double rough = relaxation_error(mesh, pulled, Relaxation::deviatoric, 10);
  const double fine = relaxation_error(mesh, pulled, Relaxation::deviatoric, 20);
  CHECK(fine <= 1e-5);
  CHECK(rough / fine > 3.5);
}

TEST_CASE("a ramp is exact for any step, creep is of second order", "[model][viscous][oracle]") {
  const Mesh<Hex8> mesh = box_hex8({1, 1, 1}, {2, 2, 2});
  const auto rows = oracle_rows("closed_form_ramp_creep_harmonic.csv");
  REQUIRE(rows.size() == 18);
  for (const LoadCase& load_case : {sheared, pulled}) {
    Equilibrium body(make_constrained_body(make_body(mesh, cube_material(Relaxation::whole_stress)),
                                           supports_of(load_case, mesh, applied_strain)));
    const VectorX full = body.conditions().prescribed;
    double time = 0.0;
    for (const auto& row : rows) {
      body.set_prescribed(std::min(row[0] / 0.2, 1.0) * full);
      REQUIRE(body.step(row[0] - time).converged);
      time = row[0];
      CHECK_THAT(stress_of(load_case, mesh, body), WithinAbs(row[load_case.column == sheared.column ? 1 : 2], 1e-8));
    }
  }
  const auto creep_error = [&](int steps) {
    const Components no_x{0.0, std::nullopt, std::nullopt}, no_y{std::nullopt, 0.0, std::nullopt};
    Scene loaded;
    loaded.prescribe("x0", no_x).prescribe("y0", no_y).prescribe("z0", Components{std::nullopt, std::nullopt, 0.0});
    loaded.traction("x1", {100.0, 0.0, 0.0});
    Equilibrium body(make_constrained_body(make_body(mesh, cube_material(Relaxation::whole_stress)), loaded));
    double time = 0.0, worst = 0.0;
    for (const auto& row : rows) {
      const int count = row[0] == 0.0 ? 1 : steps;
      for (int k = 0; k < count; ++k) REQUIRE(body.step((row[0] - time) / count).converged);
      time = row[0];
      double end = 0.0;
      for (Index i = 0; i < mesh.node_count(); ++i)
        if (mesh.position(i).x() > 1.0 - 1e-9) end = body.displacement()[3 * i];
      worst = std::max(worst, std::abs(end / row[3] - 1.0));
    }
    return worst;
  };
  const double rough = creep_error(20), fine = creep_error(40);
  CHECK(fine <= 1e-5);
  CHECK(rough / fine > 3.5);
}

TEST_CASE("the response to harmonic strain has the complex modulus", "[model][viscous][oracle]") {
  const Mesh<Hex8> mesh = box_hex8({1, 1, 1}, {2, 2, 2});
  const auto error = [&](const std::vector<double>& row, int steps) {
    Equilibrium body(
        make_constrained_body(make_body(mesh, cube_material(Relaxation::deviatoric)), supports_of(sheared, mesh, 1.0)));
    const VectorX full = body.conditions().prescribed;
    const double h = period / row[0] / steps;
    const int still = steps * (1 + static_cast<int>(20.0 * tau * row[0] / period));  // until transients have decayed
    double storage = 0.0, loss = 0.0;
    for (int k = 1; k <= still + steps; ++k) {
      const double angle = period * k / steps;
      body.set_prescribed(applied_strain * std::sin(angle) * full);
      REQUIRE(body.step(h).converged);
      if (k <= still) continue;
      const double modulus = stress_of(sheared, mesh, body) / applied_strain * 2.0 / steps;
      storage += modulus * std::sin(angle);
      loss += modulus * std::cos(angle);
    }
    return std::hypot(storage - row[1], loss - row[2]) / row[1];
  };
  const auto rows = oracle_rows("closed_form_complex_modulus.csv");
  REQUIRE(rows.size() == 8);
  for (const auto& row : rows) {
    if (row[0] > 10.0) break;  // transients would take thousands of periods to decay
    INFO("omega = " << row[0]);
    const double rough = error(row, 40), fine = error(row, 80);
    CHECK(fine <= 1e-3);
    CHECK((rough / fine > 3.5 || fine <= 1e-7));
  }
}

TEST_CASE("each region relaxes with its own time constant", "[model][viscous]") {
  Mesh<Hex8> mesh = box_hex8({1, 1, 1}, {2, 1, 1});
  mesh.region_names = {"left", "right"};
  mesh.regions.assign(2, 0);
  mesh.regions[1] = 1;
  const LinearElastic base{1e4, 0.0, 1000.0};  // in a row: the same force in both
  const auto law = [&](PronyTerm term) { return Cube{base, {{term}}, Relaxation::whole_stress}; };
  const RegionMaterials<Cube> materials{{"left", law({0.5, 0.1})}, {"right", law({0.3, 10.0})}};
  Equilibrium body(make_constrained_body(make_body(mesh, materials), supports_of(pulled, mesh, applied_strain)));
  REQUIRE(body.step(0.0).converged);
  CHECK_THAT(stress_of(pulled, mesh, body), WithinRel(100.0, 1e-9));
  REQUIRE(body.step(infinity).converged);
  CHECK_THAT(stress_of(pulled, mesh, body), WithinRel(1e4 * 2.0 * applied_strain / (1.0 / 0.5 + 1.0 / 0.7), 1e-9));
}

TEST_CASE("a constant deformation relaxes exactly at large strain too", "[model][viscous]") {
  const Mesh<Tet4> mesh = box_tet4({0.04, 0.04, 0.04}, {2, 2, 2});
  Scene scene;
  Matrix3 a;
  a << 1.3, 0.4, 0.0, 0.1, 0.8, 0.1, 0.0, -0.2, 0.9;
  for (const NodeId i : nodes_of(extract_boundary<Tet4>(mesh))) {
    const Vector3 u = a * mesh.position(i) - mesh.position(i);
    scene.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  const NeoHookean base{5e3, 0.45, 1000.0};
  Equilibrium elastic(make_hyperelastic_body(mesh, std::vector<NeoHookean>{base}), scene);
  REQUIRE(elastic.solve().converged);
  const VectorX fast = elastic.reactions();
  const Viscoelastic<NeoHookean, 2> material{base, {{{0.3, 0.1}, {0.2, 2.0}}}, Relaxation::whole_stress};
  Equilibrium body(make_hyperelastic_body(mesh, std::vector{material}), scene);
  double time = 0.0;
  for (const double dt : {0.0, 0.02, 0.3, 1.0, 5.0}) {
    time += dt;
    REQUIRE(body.step(dt).converged);
    const double left = 0.5 + 0.3 * std::exp(-time / 0.1) + 0.2 * std::exp(-time / 2.0);
    CHECK((body.reactions() - left * fast).norm() <= 1e-10 * fast.norm());
  }
  REQUIRE(body.solve().converged);
  CHECK((body.reactions() - 0.5 * fast).norm() <= 1e-10 * fast.norm());
}

TEST_CASE("at small strain both kinematics agree", "[model][viscous]") {
  const Mesh<Hex8> mesh = box_hex8({1, 1, 1}, {2, 2, 2});
  for (const auto relaxation : {Relaxation::whole_stress, Relaxation::deviatoric}) {
    const double small = 1e-6;
    Equilibrium linear(
        make_constrained_body(make_body(mesh, cube_material(relaxation)), supports_of(pulled, mesh, small)));
    Equilibrium large(make_hyperelastic_body(mesh, std::vector{Viscoelastic<NeoHookean, 1>{
                                                       {1e4, 0.45, 1000.0}, {{{share, tau}}}, relaxation}}),
                      supports_of(pulled, mesh, small));
    for (const double dt : {0.0, 0.1, 0.1, 0.5, 2.0}) {
      REQUIRE(linear.step(dt).converged);
      REQUIRE(large.step(dt).converged);
      CHECK_THAT(stress_of(pulled, mesh, large), WithinRel(stress_of(pulled, mesh, linear), 1e-4));
    }
  }
}

namespace {

/// A viscoelastic oscillator: m x'' + k (x relaxing) = 0, suddenly released from 1 mm.
struct Solid {
  double mass, stiffness;

  /// Sum of exp(s t) over the roots of the characteristic equation (m s^2 (s + 1/tau) + k (s + (1 - g)/tau) = 0).
  double at(double t) const {
    using C = std::complex<double>;
    const double a = 1.0 / tau, w = stiffness / mass;
    std::array<C, 3> s{C(-0.3, 0.9), C(-0.5, -0.7), C(-0.9, 0.1)};
    for (C& r : s) r *= std::sqrt(w);
    for (int k = 0; k < 200; ++k)  // Durand and Kerner
      for (std::size_t i = 0; i < 3; ++i) {
        const C r = s[i], p = r * r * (r + a) + w * (r + (1.0 - share) * a);
        s[i] = r - p / ((r - s[(i + 1) % 3]) * (r - s[(i + 2) % 3]));
      }
    // x = 1, x' = 0, x'' = -w at t = 0
    Eigen::Matrix3cd v;
    for (int i = 0; i < 3; ++i)
      v.col(i) << 1.0, s[static_cast<std::size_t>(i)], s[static_cast<std::size_t>(i)] * s[static_cast<std::size_t>(i)];
    const Eigen::Vector3cd c = v.fullPivLu().solve(Eigen::Vector3cd(1.0, 0.0, -w));
    C x = 0.0;
    for (int i = 0; i < 3; ++i) x += c[i] * std::exp(s[static_cast<std::size_t>(i)] * t);
    return x.real();
  }
};

DeformableBody solid_body() {
  Scene scene;
  scene.prescribe("x0", {0.0, 0.0, 0.0}).prescribe("x1", Components{std::nullopt, 0.0, 0.0});
  return make_deformable_body(
      make_body(box_hex8({1, 1, 1}, {1, 1, 1}),
                Cube{LinearElastic{1e4, 0.0, 1000.0}, {{{share, tau}}}, Relaxation::whole_stress}),
      scene);
}
double released_solid(TimeScheme scheme, double time, int steps) {
  ImplicitDynamics d(solid_body(), {.scheme = scheme});
  VectorX u = VectorX::Zero(d.displacement().size());
  for (const Index dof : d.body().conditions.free_dofs) u[dof] = 1e-3;
  d.set_state(u, VectorX::Zero(u.size()));
  for (int k = 0; k < steps; ++k) REQUIRE(d.step(time / steps).newton.converged);
  return d.displacement()[d.body().conditions.free_dofs.front()] / 1e-3;
}

}  // namespace

TEST_CASE("a viscoelastic oscillator moves as its closed form", "[model][viscous][dynamics]") {
  const Solid exact{500.0, 1e4};
  for (const double time : {0.6, 2.0}) {
    const double x = exact.at(time);
    const auto error = [&](TimeScheme s, int n) { return std::abs(released_solid(s, time, n) - x); };
    CHECK(error(TimeScheme::newmark(), 400) <= 1e-3);
    CHECK_THAT(error(TimeScheme::newmark(), 400) / error(TimeScheme::newmark(), 800), WithinAbs(4.0, 0.3));
    CHECK_THAT(error(TimeScheme::implicit_euler(), 4000) / error(TimeScheme::implicit_euler(), 8000),
               WithinAbs(2.0, 0.1));
  }
}

TEST_CASE("a correction counts once in the viscoelastic history", "[model][viscous][dynamics]") {
  const double h = 0.01;
  ImplicitDynamics all(solid_body(), {}), later(solid_body(), {}), twice(solid_body(), {});
  VectorX force = VectorX::Zero(all.displacement().size());
  for (const Index dof : all.body().conditions.free_dofs) force[dof] = 1.0;
  for (int k = 0; k < 30; ++k) {
    all.set_load((1.0 + 0.1 * k) * force);
    later.set_load((0.4 + 0.1 * k) * force);
    twice.set_load((0.4 + 0.1 * k) * force);
    for (ImplicitDynamics* d : {&all, &later, &twice}) REQUIRE(d->step(h).taken);
    REQUIRE(later.correct(0.6 * force));
    REQUIRE(twice.correct(0.5 * force));
    REQUIRE(twice.correct(0.1 * force));
  }
  CHECK((later.displacement() - all.displacement()).norm() <= 1e-9 * all.displacement().norm());
  CHECK((twice.displacement() - all.displacement()).norm() <= 1e-9 * all.displacement().norm());
}

TEST_CASE("a refused step does not change the viscoelastic history", "[model][viscous][dynamics]") {
  const Mesh<Tet4> mesh = box_tet4({0.04, 0.04, 0.04}, {2, 2, 2});
  const Viscoelastic<NeoHookean, 1> material{{5e3, 0.45, 1000.0}, {{{0.6, 0.05}}}};
  const auto body = [&] {
    return make_deformable_body(make_hyperelastic_body(mesh, std::vector{material}),
                                Scene().fix("z0").gravity({9.81, 0.0, 0.0}));
  };
  ImplicitDynamics one(body(), {}), other(body(), {});
  const VectorX constrained = one.body().conditions.prescribed;
  for (int k = 0; k < 20; ++k) {
    REQUIRE(one.step(0.01).taken);
    REQUIRE(other.step(0.01).taken);
    other.set_prescribed(VectorX::Constant(constrained.size(), std::numeric_limits<double>::quiet_NaN()));
    REQUIRE_FALSE(other.step(0.5).taken);
    CHECK_FALSE(other.step(-1.0).taken);
    other.set_prescribed(constrained);
    CHECK(other.prepare_response(0.3));
  }
  CHECK(one.displacement() == other.displacement());
}

TEST_CASE("viscoelastic motion dissipates energy and settles in the static equilibrium", "[model][viscous][dynamics]") {
  const Mesh<Tet4> mesh = box_tet4({0.04, 0.04, 0.08}, {2, 2, 4});
  const Scene scene = Scene().fix("z0").gravity({4.0, 0.0, -9.81});
  for (const auto relaxation : {Relaxation::whole_stress, Relaxation::deviatoric}) {
    const Viscoelastic<NeoHookean, 2> material{{8e3, 0.4, 1000.0}, {{{0.3, 0.02}, {0.2, 0.2}}}, relaxation};
    Equilibrium statics(make_hyperelastic_body(mesh, std::vector{material}), scene);
    REQUIRE(statics.solve().converged);
    ImplicitDynamics d(make_deformable_body(make_hyperelastic_body(mesh, std::vector{material}), scene), {});
    StepReport report;
    for (int k = 0; k < 400; ++k) report = d.step(0.02);
    REQUIRE(report.newton.converged);
    CHECK((d.displacement() - statics.displacement()).norm() <= 1e-6 * statics.displacement().norm());
  }
}

TEST_CASE("a viscoelastic step allocates nothing; with zero terms it is that of the base material",
          "[model][viscous][allocation]") {
  const Mesh<Tet4> mesh = box_tet4({0.04, 0.04, 0.08}, {2, 2, 4});
  const Scene scene = Scene().fix("z0").gravity({4.0, 0.0, -9.81});
  const NeoHookean base{8e3, 0.4, 1000.0};
  const Viscoelastic<NeoHookean, 1> material{base, {{{0.3, 0.02}}}}, none{base, {{{0.0, 0.02}}}};
  ImplicitDynamics plain(make_deformable_body(make_hyperelastic_body(mesh, std::vector{base}), scene), {});
  ImplicitDynamics viscous(make_deformable_body(make_hyperelastic_body(mesh, std::vector{material}), scene), {});
  ImplicitDynamics idle(make_deformable_body(make_hyperelastic_body(mesh, std::vector{none}), scene), {});
  ImplicitDynamics small(
      make_deformable_body(make_body(mesh, Cube{LinearElastic{8e3, 0.4, 1000.0}, {{{0.3, 0.02}}}}), scene), {});
  const testing::AllocationScope scope;
  for (int k = 0; k < 20; ++k)
    for (ImplicitDynamics* d : {&plain, &viscous, &idle, &small}) d->step(0.005);
  const std::uint64_t allocations = scope.allocations();
  CHECK(allocations == 0);
  CHECK((plain.displacement() - idle.displacement()).norm() <= 1e-9 * plain.displacement().norm());
  CHECK((plain.displacement() - viscous.displacement()).norm() > 1e-3 * plain.displacement().norm());
  STATIC_REQUIRE(std::is_empty_v<detail::PointHistory<NeoHookean, 1>::type>);
}

TEST_CASE("viscoelastic bodies refuse unsupported set-ups", "[model][viscous]") {
  const Mesh<Tet4> mesh = box_tet4({1, 1, 1}, {1, 1, 1});
  const auto kind = [](auto make) {
    try {
      make();
    } catch (const SetupError& error) {
      return error.kind();
    }
    return SetupErrorKind::cancelled;
  };
  const TransverselyIsotropic fibrous{.youngs_modulus_along = 2e4,
                                      .youngs_modulus_across = 1e4,
                                      .poisson_ratio_along = 0.3,
                                      .poisson_ratio_across = 0.3,
                                      .shear_modulus_along = 4e3,
                                      .density = 1e3};
  using Muscle = Viscoelastic<TransverselyIsotropic, 1>;
  const Muscle whole{fibrous, {{{0.5, 1.0}}}, Relaxation::whole_stress},
      shape{fibrous, {{{0.5, 1.0}}}, Relaxation::deviatoric};
  const Scene constrained = Scene().fix("z0");
  CHECK(kind([&] { make_constrained_body(make_body(mesh, whole), constrained); }) == SetupErrorKind::cancelled);
  CHECK(kind([&] { make_constrained_body(make_body(mesh, shape), constrained); }) == SetupErrorKind::unsupported);
  const Cube cube = cube_material(Relaxation::whole_stress);
  CHECK(kind([&] { make_constrained_body(make_body(mesh, cube), Scene()); }) == SetupErrorKind::unconstrained);
  CHECK(kind([&] {
          Scene expanding = constrained;
          make_constrained_body(make_body(mesh, cube), expanding.expand(std::string(everywhere), 0.01));
        }) == SetupErrorKind::unsupported);
  CHECK(kind([&] { make_body(mesh, Cube{cube.base, {{{1.5, 1.0}}}}); }) == SetupErrorKind::bad_argument);
  Equilibrium body(make_constrained_body(make_body(mesh, cube), constrained));
  for (const double dt : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    CHECK(kind([&] { body.step(dt); }) == SetupErrorKind::bad_argument);
}

namespace {

/// Largest displacement of the inner nodes of a swollen cube, relative to the uniform state, two seconds after a
/// disturbance of 1e-4 m/s.
double disturbance_of_swollen_cube(const Viscoelastic<NeoHookean, 1>& law) {
  const double edge = 0.05, stretch = std::cbrt(1.06);
  const auto mesh = promote<Tet10>(box_tet4({edge, edge, edge}, {2, 2, 2}, BoxSplit::six));
  Scene scene;
  for (const char* face : {"x0", "x1", "y0", "y1", "z0", "z1"}) scene.fix(face);
  ImplicitDynamics motion(make_deformable_body(make_hyperelastic_body(mesh, std::vector{law}), scene));
  VectorX u(3 * mesh.node_count()), v(u.size());
  for (Index i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = (stretch - 1.0) * mesh.position(i);
  testing::Random random(3);
  for (double& x : v) x = random.uniform(-1e-4, 1e-4);
  motion.set_prescribed(u);
  motion.set_state(u, v);
  for (int k = 0; k < 400; ++k)
    if (!motion.step(0.005).taken) return infinity;
  return (motion.displacement() - u).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a stretched viscoelastic body stays at rest", "[model][viscous][energy]") {
  Viscoelastic<NeoHookean, 1> law{{5e3, 0.49, 1000.0}, {{{0.6, 0.05}}}};
  CHECK(disturbance_of_swollen_cube(law) <= 2e-7);
  law.relaxation = Relaxation::whole_stress;  // why it is not the default
  CHECK(disturbance_of_swollen_cube(law) >= 1e-4);
}
