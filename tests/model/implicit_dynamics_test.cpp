// Dynamics against closed forms, conservation laws and another code.
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/io/detail/text_reader.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/neo_hookean_logarithmic.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include <numbers>
#include <sstream>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double length = 0.1, youngs_modulus = 1e4, density = 1e3;

/// A cube that can only stretch uniformly along x: an oscillator of mass m = rho V / 2 (half of it at the free end) and
/// stiffness E A / L.
DeformableBody oscillator(double load = 0.0) {
  Scene scene;
  const Components still{0.0, 0.0, 0.0}, along{std::nullopt, 0.0, 0.0};
  scene.prescribe("x0", still).prescribe("x1", along).traction("x1", {load, 0.0, 0.0});
  return make_deformable_body(
      make_body(box_hex8({length, length, length}, {1, 1, 1}), LinearElastic{youngs_modulus, 0.0, density}), scene);
}
const double omega = std::sqrt(youngs_modulus * length / (0.5 * density * length * length * length));

double end_of(const ImplicitDynamics& d) {
  return d.displacement()[d.body().conditions.free_dofs.front()];
}
/// Releases it from a displacement of 1 mm.
void release(ImplicitDynamics& d) {
  VectorX u = VectorX::Zero(d.displacement().size());
  for (const Index dof : d.body().conditions.free_dofs) u[dof] = 1e-3;
  d.set_state(u, VectorX::Zero(u.size()));
}

/// Displacement of the free end after `time`, released from 1 mm.
double released(TimeScheme scheme, int steps, double time, double damping = 0.0) {
  ImplicitDynamics d(oscillator(), {.scheme = scheme, .mass_damping = damping});
  release(d);
  for (int k = 0; k < steps; ++k) REQUIRE(d.step(time / steps).newton.converged);
  return end_of(d);
}

HyperelasticBody<Tet4, NeoHookean> block(double poisson_ratio = 0.4) {
  return make_hyperelastic_body(box_tet4({0.04, 0.04, 0.08}, {2, 2, 4}),
                                std::vector<NeoHookean>{{5e3, poisson_ratio, density}});
}

Vector3 momentum(const ImplicitDynamics& d) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < d.body().lumped.size(); ++i) sum += d.body().lumped[i] * d.velocity().segment<3>(3 * i);
  return sum;
}
Vector3 angular_momentum(const ImplicitDynamics& d) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < d.body().lumped.size(); ++i) {
    const Vector3 x = d.body().positions[static_cast<std::size_t>(i)] + d.displacement().segment<3>(3 * i);
    sum += d.body().lumped[i] * x.cross(d.velocity().segment<3>(3 * i));
  }
  return sum;
}

}  // namespace

TEST_CASE("time schemes have their orders", "[model][dynamics]") {
  const double time = 0.8 * 2.0 * std::numbers::pi / omega, exact = 1e-3 * std::cos(omega * time);
  const auto error = [&](TimeScheme s, int steps) { return std::abs(released(s, steps, time) - exact); };
  CHECK_THAT(error(TimeScheme::newmark(), 40) / error(TimeScheme::newmark(), 80), WithinAbs(4.0, 0.2));
  CHECK_THAT(error(TimeScheme::implicit_euler(), 2000) / error(TimeScheme::implicit_euler(), 4000),
             WithinAbs(2.0, 0.1));
}

TEST_CASE("implicit Euler damps an oscillation as predicted by theory", "[model][dynamics]") {
  const double h = 0.1 / omega;
  ImplicitDynamics d(oscillator(), {});
  release(d);
  // The energy of the scheme, x^2 + (v / omega)^2, falls by 1 / (1 + (omega h)^2) in every step
  double before = d.displacement().squaredNorm();
  for (int k = 0; k < 100; ++k) {
    d.step(h);
    const double after = d.displacement().squaredNorm() + d.velocity().squaredNorm() / (omega * omega);
    CHECK_THAT(after / before, WithinRel(1.0 / 1.01, 1e-9));
    before = after;
  }
}

TEST_CASE("a damped oscillator follows its closed form", "[model][dynamics]") {
  const double ratio = 0.2, time = 2.0 / omega, damped = omega * std::sqrt(1.0 - ratio * ratio);
  const double exact = 1e-3 * std::exp(-ratio * omega * time) *
                       (std::cos(damped * time) + ratio * omega / damped * std::sin(damped * time));
  CHECK_THAT(released(TimeScheme::newmark(), 2000, time, 2.0 * ratio * omega), WithinAbs(exact, 1e-3 * 1e-6));
  // Stiffness-proportional: beta = 2 ratio / omega gives the same motion.
  ImplicitDynamics d(oscillator(), {.scheme = TimeScheme::newmark(), .stiffness_damping = 2.0 * ratio / omega});
  release(d);
  for (int k = 0; k < 2000; ++k) d.step(time / 2000);
  CHECK_THAT(end_of(d), WithinAbs(exact, 1e-3 * 1e-6));
}

TEST_CASE("the trapezoidal rule keeps the energy of a linear body, implicit Euler never adds any",
          "[model][dynamics][energy]") {
  for (const bool trapezoidal : {true, false}) {
    ImplicitDynamics d(oscillator(30.0),
                       {.scheme = trapezoidal ? TimeScheme::newmark() : TimeScheme::implicit_euler()});
    const double start = d.energy();
    double kinetic = 0.0, before = start;
    for (int k = 0; k < 2000; ++k) {
      d.step(0.2 / omega);
      kinetic = std::max(kinetic, d.kinetic_energy());
      if (trapezoidal)
        CHECK_THAT(d.energy(), WithinAbs(start, 1e-12 * kinetic));
      else
        CHECK(d.energy() <= before + 1e-14 * kinetic);
      before = d.energy();
    }
  }
}

TEST_CASE("an elastic bar under a sudden pull moves as in another code", "[model][dynamics][oracle]") {
  const std::string folder = PALPATE_TEST_DATA "/oracle/L_dynamic/bar_hex8";
  const auto mesh = io::read_mesh<Hex8>(folder + "/mesh_v22.msh");
  const Scene scene = Scene().fix("fixed").traction("load", {1000.0, 0.0, 0.0});
  ImplicitDynamics d(make_deformable_body(make_body(mesh, LinearElastic{1e6, 0.0, 1e3}), scene),
                     {.scheme = TimeScheme::newmark(), .mass = MassKind::consistent});
  Index tip = 0;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i).x() > mesh.position(tip).x()) tip = i;
  const std::string text = io::read_file(folder + "/history.csv");
  io::TextReader in(text, "history.csv");
  in.need_line("a header");
  const double h = 0.000158113883008;  // of the reference
  double worst = 0.0;
  int rows = 0;
  while (in.next_line()) {
    std::vector<double> row;
    std::string line(in.rest());
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    for (double x = 0.0; row.size() < 3 && numbers >> x;) row.push_back(x);
    REQUIRE(row.size() == 3);
    while (d.time() < row[0] - 0.5 * h) REQUIRE(d.step(h).newton.converged);
    worst = std::max(worst, std::abs(d.displacement()[3 * tip] - row[2]));
    ++rows;
  }
  CHECK(rows > 100);
  CHECK(worst <= 1e-8 * 2e-3);  // printed with 9 digits
}

TEST_CASE("a free body conserves its momentum and falls with gravity", "[model][dynamics][energy]") {
  Scene scene;
  scene.gravity({0.0, 0.0, -9.81});
  for (const TimeScheme scheme : {TimeScheme::implicit_euler(), TimeScheme::newmark()}) {
    ImplicitDynamics d(make_deformable_body(block(), scene), {.scheme = scheme});
    testing::Random random(7);
    VectorX u = VectorX::Zero(d.displacement().size()), v(u.size());
    for (double& x : v) x = random.uniform(-0.2, 0.2);
    d.set_state(u, v);
    const double mass = d.body().lumped.sum();
    const Vector3 start = momentum(d);
    for (int k = 1; k <= 50; ++k) {
      REQUIRE(d.step(2e-3).newton.converged);
      const Vector3 expected = start - Vector3(0.0, 0.0, 9.81 * mass * d.time());
      CHECK((momentum(d) - expected).norm() <= 1e-10 * expected.norm());
    }
  }
  ImplicitDynamics rotating(make_deformable_body(block(), Scene()), {.scheme = TimeScheme::implicit_euler()});
  VectorX v(rotating.displacement().size());
  for (Index i = 0; i < v.size() / 3; ++i)
    v.segment<3>(3 * i) = Vector3(0.0, 0.0, 5.0).cross(rotating.body().positions[static_cast<std::size_t>(i)]);
  rotating.set_state(VectorX::Zero(v.size()), v);
  const double spin = angular_momentum(rotating).z();
  double before = spin;
  for (int k = 0; k < 50; ++k) {
    REQUIRE(rotating.step(2e-3).newton.converged);
    const double now = angular_momentum(rotating).z();
    CHECK(std::abs(now) <=
          std::abs(before) * (1.0 + 1e-9));  // implicit Euler loses angular momentum and never gains any
    before = now;
  }
  CHECK(before > 0.5 * spin);
}

// The potential of a body that only drifts is a difference of large numbers and close to zero.
TEST_CASE("steps of a free body converge after its oscillation has decayed", "[model][dynamics]") {
  const NeoHookean soft{.youngs_modulus = 3e3, .poisson_ratio = 0.45, .density = density};
  const Mesh<Tet4> cube = box_tet4(Vector3(0.1, 0.1, 0.1), {2, 2, 2}, BoxSplit::six);
  ImplicitDynamics d(make_deformable_body(make_body(cube, soft.small_strain()), Scene()),
                     {.scheme = TimeScheme::implicit_euler(), .newton = {.tolerance = 1e-13}});
  VectorX v(d.displacement().size());
  for (Index i = 0; i < v.size() / 3; ++i) {
    const Vector3 r = cube.position(static_cast<NodeId>(i)) - Vector3(0.05, 0.05, 0.05);
    v.segment<3>(3 * i) = 0.01 * Vector3(0.2 + 3.0 * r.x(), -0.1 - 2.0 * r.y(), 0.3 + 4.0 * r.z());
  }
  d.set_state(VectorX::Zero(v.size()), v);
  const Vector3 start = momentum(d);
  int failed = 0;
  for (int k = 0; k < 6000; ++k) failed += d.step(2e-3).newton.converged ? 0 : 1;
  CHECK(failed == 0);
  CHECK((momentum(d) - start).norm() <= 1e-8 * start.norm());
}

TEST_CASE("a body at rest stays at rest, and a settled one agrees with statics", "[model][dynamics]") {
  const Scene scene = Scene().fix("z0").gravity({9.81, 0.0, 0.0});
  Equilibrium statics(block(), scene);
  REQUIRE(statics.solve().converged);
  ImplicitDynamics d(make_deformable_body(block(), scene), {.mass_damping = 20.0});
  StepReport report;
  for (int k = 0; k < 400; ++k) report = d.step(0.02);
  CHECK(report.taken);
  CHECK((d.displacement() - statics.displacement()).norm() <= 1e-7 * statics.displacement().norm());
  ImplicitDynamics still(make_deformable_body(block(), Scene().fix("z0")), {});
  for (int k = 0; k < 20; ++k) still.step(1e-3);
  CHECK(still.displacement().isZero(0.0));
}

TEST_CASE("steps of any length are bounded, and invalid steps are not taken", "[model][dynamics][extreme][E1]") {
  for (const double h : {1e-9, 1e-6, 1e-3, 0.1, 1.0, 100.0}) {
    ImplicitDynamics d(make_deformable_body(block(), Scene().fix("z0").gravity({9.81, 0.0, 0.0})), {});
    double before = d.energy();
    for (int k = 0; k < 8; ++k) {
      const StepReport report = d.step(h);
      CHECK(report.taken);
      CHECK(d.displacement().allFinite());
      const double now = d.energy();
      CHECK(now <= before + 1e-12 * std::abs(before) + 1e-18);
      before = now;
    }
  }
  ImplicitDynamics d(make_deformable_body(block(), Scene().fix("z0").gravity({9.81, 0.0, 0.0})), {});
  d.step(1e-3);
  const VectorX u = d.displacement();
  for (const double h : {0.0, -1e-3, std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    CHECK_FALSE(d.step(h).taken);
    CHECK(d.displacement() == u);
    CHECK(d.time() == 1e-3);
  }
}

TEST_CASE("bodies with random displacements settle to rest", "[model][dynamics][extreme][E5]") {
  testing::Random random(11);
  int settled = 0;
  constexpr int runs = 12;
  for (int run = 0; run < runs; ++run) {
    ImplicitDynamics d(make_deformable_body(block(), Scene().fix("z0")), {.mass_damping = 5.0});
    VectorX u(d.displacement().size());
    for (double& x : u) x = random.uniform(-0.04, 0.04);
    d.set_state(u, VectorX::Zero(u.size()));
    for (int k = 0; k < 150; ++k) {
      d.step(0.02);
      REQUIRE(d.displacement().allFinite());
    }
    if (d.displacement().cwiseAbs().maxCoeff() <= 1e-3) ++settled;
  }
  CHECK(settled == runs);
}

TEST_CASE("a motion set to a state again repeats itself to the last bit", "[model][dynamics]") {
  testing::Random random(11);
  ImplicitDynamics d(make_deformable_body(block(), Scene().fix("z0")), {.mass_damping = 5.0});
  VectorX folded(d.displacement().size());
  for (double& x : folded) x = random.uniform(-0.08, 0.08);  // tangents that are not positive definite
  std::vector<VectorX> first;
  for (int run = 0; run < 2; ++run) {
    d.rest_at(folded);
    for (std::size_t k = 0; k < 10; ++k) {
      d.step(0.02);
      if (run == 0) first.push_back(d.displacement());
      CHECK(d.displacement() == first[k]);
    }
  }
}

TEST_CASE("dynamics refuses bodies without mass, and negative damping", "[model][dynamics]") {
  const auto kind = [](DeformableBody body, const DynamicsParameters& parameters) {
    try {
      ImplicitDynamics d(std::move(body), parameters);
    } catch (const SetupError& error) {
      return error.kind();
    }
    return SetupErrorKind::cancelled;
  };
  const auto weightless = [] {
    return make_deformable_body(make_body(box_tet4({1, 1, 1}, {1, 1, 1}), LinearElastic{1e3, 0.3, 0.0}),
                                Scene().fix("x0"));
  };
  CHECK(kind(weightless(), {}) == SetupErrorKind::bad_density);
  CHECK(kind(oscillator(), {.mass_damping = -1.0}) == SetupErrorKind::bad_argument);
  CHECK(kind(oscillator(), {.stiffness_damping = std::numeric_limits<double>::quiet_NaN()}) ==
        SetupErrorKind::bad_argument);
  CHECK(kind(oscillator(), {.newton = {.maximum_iterations = 0}}) == SetupErrorKind::bad_argument);
  CHECK(kind(oscillator(), {.newton = {.tolerance = -1.0}}) == SetupErrorKind::bad_argument);
  CHECK(kind(oscillator(), {.newton = {.maximum_halvings = -1}}) == SetupErrorKind::bad_argument);
  CHECK(kind(oscillator(), {.scheme = TimeScheme::newmark(0.0, 0.5)}) == SetupErrorKind::bad_argument);
}

TEST_CASE("a correction uses the tangent, also after a step without iterations", "[model][dynamics]") {
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    const Scene scene = Scene().fix("z0");
    ImplicitDynamics d(make_deformable_body(block(), scene), {.mass = mass});
    VectorX force = VectorX::Zero(d.displacement().size()), expected(force.size());
    force[d.body().conditions.free_dofs.back()] = 1e-3;
    const double h = 5e-3;
    REQUIRE(d.step(h).newton.iterations == 0);
    REQUIRE(d.correct(force));
    ImplicitDynamics fresh(make_deformable_body(block(), scene), {.mass = mass});
    REQUIRE(fresh.prepare_response(h));
    fresh.respond(force, expected);
    REQUIRE(expected.norm() > 0.0);
    CHECK((d.displacement() - expected).norm() <= 1e-12 * expected.norm());
    // the same force applied from the start of the step gives the same result to first order
    ImplicitDynamics loaded(make_deformable_body(block(), scene), {.mass = mass});
    loaded.set_load(1e-3 * force);
    REQUIRE(loaded.step(h).newton.converged);
    CHECK((1e3 * loaded.displacement() - expected).norm() <= 1e-3 * expected.norm());
  }
}

TEST_CASE("only the end of a step is corrected, and the result is always a valid state", "[model][dynamics]") {
  const auto scene = Scene().fix("z0");
  ImplicitDynamics d(
      make_deformable_body(make_hyperelastic_body(box_tet4({0.04, 0.04, 0.08}, {2, 2, 4}),
                                                  std::vector<NeoHookeanLogarithmic>{{5e3, 0.4, density}}),
                           scene),
      {});
  VectorX force = VectorX::Zero(d.displacement().size());
  force[force.size() - 1] = 1e-4;
  CHECK_FALSE(d.correct(force));
  d.step(5e-3);
  CHECK(d.correct(force));
  const VectorX u = d.displacement();
  REQUIRE(u.norm() > 0.0);
  for (const double size : {-1e6, 1e300, 1e308, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_FALSE(d.correct((size / 1e-4) * force));
    CHECK(d.displacement() == u);
  }
  d.prepare_response(1e-3);
  CHECK_FALSE(d.correct(force));  // no step to correct
  CHECK(d.displacement() == u);
  REQUIRE(d.step(5e-3).taken);
  d.set_prescribed(VectorX::Constant(u.size(), std::numeric_limits<double>::quiet_NaN()));
  const VectorX last = d.displacement();
  REQUIRE_FALSE(d.step(1e-3).taken);
  CHECK_FALSE(d.correct(force));
  CHECK(d.displacement() == last);
}

TEST_CASE("set_state applies the prescribed values", "[model][dynamics]") {
  const Scene scene = Scene().fix("z0").prescribe("z1", {0.0, 0.0, -0.02});
  Equilibrium statics(block(), scene);
  REQUIRE(statics.solve().converged);
  ImplicitDynamics d(make_deformable_body(block(), scene), {});
  d.set_state(statics.displacement(), VectorX::Zero(d.displacement().size()));
  CHECK(d.displacement() == statics.displacement());
  CHECK(d.acceleration().norm() <= 1e-6);
  for (int k = 0; k < 5; ++k) d.step(1e-3);
  CHECK((d.displacement() - statics.displacement()).norm() <= 1e-9 * statics.displacement().norm());
}

TEST_CASE("a correction does not move prescribed nodes", "[model][dynamics]") {
  const Scene scene = Scene().fix("z0").prescribe("z1", {0.0, 0.0, 0.0});
  ImplicitDynamics d(make_deformable_body(block(), scene), {}), same(make_deformable_body(block(), scene), {});
  VectorX force = VectorX::Zero(d.displacement().size());
  force[d.body().conditions.free_dofs.front()] = 1e-3;
  for (ImplicitDynamics* motion : {&d, &same}) REQUIRE(motion->step(5e-3).taken);
  d.set_prescribed(0.01 * VectorX::Ones(force.size()));  // of the next step
  REQUIRE(d.correct(force));
  REQUIRE(same.correct(force));
  CHECK(d.displacement() == same.displacement());
}

TEST_CASE("a response needs a step and uses its tangent, also after a step without iterations", "[model][dynamics]") {
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    ImplicitDynamics d(make_deformable_body(block(), Scene().fix("z0")), {.mass = mass}),
        fresh(make_deformable_body(block(), Scene().fix("z0")), {.mass = mass});
    VectorX force = VectorX::Zero(d.displacement().size()), u(force.size()), expected(force.size());
    force[d.body().conditions.free_dofs.back()] = 1e-3;
    CHECK_FALSE(d.respond(force, u));
    REQUIRE(d.step(5e-3).newton.iterations == 0);
    REQUIRE(d.respond(force, u));
    REQUIRE(fresh.prepare_response(5e-3));
    REQUIRE(fresh.respond(force, expected));
    REQUIRE(expected.norm() > 0.0);
    CHECK((u - expected).norm() <= 1e-12 * expected.norm());
  }
}

TEST_CASE("the potential does not rise in a step, for any predicted displacement", "[model][dynamics][E1]") {
  const auto body = make_hyperelastic_body(box_tet4({0.04, 0.04, 0.08}, {2, 2, 4}),
                                           std::vector<StVenantKirchhoff>{{5e3, 0.4, density}});
  for (const double h : {1e-3, 1e-2, 1e-1, 1.0}) {
    ImplicitDynamics d(make_deformable_body(body, Scene().fix("z0")), {.newton = {.maximum_iterations = 2}});
    const VectorX start = VectorX::Zero(d.displacement().size());
    d.set_state(start, VectorX::Constant(start.size(), 10.0));
    const VectorX v = d.velocity();
    const double potential = d.kinetic_energy() + d.elastic_energy();  // v is what the step would lose by stopping
    REQUIRE(d.step(h).taken);
    double left = d.elastic_energy();
    for (Index i = 0; i < start.size(); ++i) {
      const double lost = d.velocity()[i] - v[i];
      left += 0.5 * d.body().lumped[i / 3] * lost * lost;
    }
    CHECK(left <= (1.0 + 1e-12) * potential);
  }
}

TEST_CASE("vectors of a wrong size are refused by motions and equilibria", "[model][dynamics][extreme]") {
  const Scene scene = Scene().fix("z0");
  ImplicitDynamics d(make_deformable_body(block(), scene), {});
  Equilibrium statics(block(), scene);
  const VectorX wrong = VectorX::Zero(d.displacement().size() + 3), right = d.displacement();
  CHECK_REFUSED(SetupErrorKind::bad_argument, d.set_load(wrong));
  CHECK_REFUSED(SetupErrorKind::bad_argument, d.set_prescribed(wrong));
  CHECK_REFUSED(SetupErrorKind::bad_argument, d.set_state(wrong, right));
  CHECK_REFUSED(SetupErrorKind::bad_argument, d.set_state(right, wrong));
  CHECK_REFUSED(SetupErrorKind::bad_argument, statics.set_load(wrong));
  CHECK_REFUSED(SetupErrorKind::bad_argument, statics.set_prescribed(wrong));
  CHECK(d.step(1e-3).taken);
  CHECK(statics.solve().converged);
}

TEST_CASE("equilibrium supports linear bodies", "[model][equilibrium]") {
  const auto body = make_body(box_tet4({0.04, 0.04, 0.08}, {2, 2, 4}), LinearElastic{5e3, 0.4, density});
  const Scene scene = Scene().fix("z0").gravity({0.0, 0.0, -9.81});
  Equilibrium statics(make_constrained_body(body, scene));
  REQUIRE(statics.solve().converged);
  CHECK_THAT(statics.reactions().sum(), WithinRel(density * 0.04 * 0.04 * 0.08 * 9.81, 1e-9));
  CHECK_REFUSED(SetupErrorKind::unconstrained, make_constrained_body(body, Scene().gravity({0.0, 0.0, -9.81})));
}

TEMPLATE_TEST_CASE("supports may move by more than a layer of elements in a step", "[model][dynamics][extreme]",
                   NeoHookean, NeoHookeanLogarithmic, StVenantKirchhoff, NeoHookeanIsochoric) {
  const double height = 0.08, layer = 0.01;
  const auto mesh = box_tet4({0.04, 0.04, height}, {2, 2, 8});
  const auto top = [&](const ImplicitDynamics& d) { return d.displacement()[3 * (mesh.node_count() - 1) + 2]; };
  for (const double moved : {-1.5 * layer, 1.5 * layer}) {
    const std::vector<TestType> law{TestType{5e3, 0.45, 1000.0}};
    ImplicitDynamics d(make_deformable_body(make_hyperelastic_body(mesh, law), Scene().fix("z0").fix("z1")),
                       {.mass_damping = 20.0}),
        slow(make_deformable_body(make_hyperelastic_body(mesh, law), Scene().fix("z0").fix("z1")),
             {.mass_damping = 20.0});
    VectorX values = VectorX::Zero(d.displacement().size());
    for (int k = 1; k <= 300; ++k) {
      for (Index i = 0; i < mesh.node_count(); ++i)
        if (mesh.position(i).z() > height - 1e-9) values[3 * i + 2] = moved;
      d.set_prescribed(values);
      slow.set_prescribed(std::min(1.0, 0.02 * k) * values);
      REQUIRE(d.step(0.01).taken);
      REQUIRE(slow.step(0.01).taken);
    }
    CHECK_THAT(top(d), WithinAbs(moved, 1e-15));
    CHECK((d.displacement() - slow.displacement()).norm() <= 1e-6 * slow.displacement().norm());
  }
}

TEST_CASE("a nearly incompressible bar follows its support in steps of two iterations, and returns",
          "[model][dynamics][extreme]") {
  const Mesh<Tet10> mesh = promote<Tet10>(box_tet4({0.06, 0.02, 0.02}, {6, 2, 2}, BoxSplit::six));
  ImplicitDynamics d(make_deformable_body(make_hyperelastic_body(mesh, std::vector{NeoHookean{5e3, 0.499, 1000.0}}),
                                          Scene().fix("x0").fix("x1")),
                     {.mass_damping = 20.0, .newton = {.maximum_iterations = 2, .tolerance = 1e-9}});
  const auto pull = [&](double stretch) {
    VectorX values = VectorX::Zero(3 * mesh.node_count());
    for (Index i = 0; i < mesh.node_count(); ++i)
      if (mesh.position(i)[0] > 0.0599) values[3 * i] = 0.06 * stretch;
    d.set_prescribed(values);
    return d.step(0.01);
  };
  constexpr int steps = 10;
  for (int k = 1; k <= steps; ++k) CHECK(pull(1.0 * k / steps).deformation.inverted == 0);
  for (int k = 0; k < 20; ++k) pull(1.0);
  for (int k = steps - 1; k >= 0; --k) CHECK(pull(1.0 * k / steps).deformation.inverted == 0);
  for (int k = 0; k < 60; ++k) pull(0.0);
  CHECK(d.displacement().cwiseAbs().maxCoeff() <= 1e-5);
}

TEST_CASE("a spring that pushes a point ends in equilibrium with the body, by Newton's method", "[model][dynamics]") {
  const auto made = [] { return make_deformable_body(block(), Scene().fix("z0")); };
  const DeformableBody body = made();
  const auto is_on_top = [&](std::size_t i) { return body.positions[i][2] > 0.0799; };
  std::size_t first = 0;
  while (!is_on_top(first)) ++first;
  const auto corner = static_cast<NodeId>(first), beside = corner + 1;  // on an edge of the block
  const Vector3 down = Vector3(0.3, 0.0, -1.0).normalized();
  const ContactSpring spring{{corner, beside, beside}, {0.6, 0.4, 0.0}, down, 0.01, 200.0};

  const DynamicsParameters parameters{.mass_damping = 20.0, .newton = {.maximum_iterations = 30, .tolerance = 1e-10}};
  ImplicitDynamics pushed(made(), parameters), loaded(made(), parameters);
  pushed.set_springs({&spring, 1});
  int most = 0;
  for (int k = 0; k < 100; ++k) {
    const StepReport report = pushed.step(0.05);
    REQUIRE(report.newton.converged);
    REQUIRE(report.energy_bounded);
    most = std::max(most, report.newton.iterations);
  }
  CHECK(most <= 8);  // also the stiffness of the spring is in the tangent
  const double push = spring.push(pushed.displacement());
  CHECK(push > 0.05);
  VectorX load = VectorX::Zero(pushed.displacement().size());
  CHECK_THAT(detail::add_pushes({&spring, 1}, pushed.displacement(), load),
             WithinRel(0.5 * push * push / 200.0, 1e-12));
  loaded.set_load(load);
  for (int k = 0; k < 100; ++k) loaded.step(0.05);
  CHECK((loaded.displacement() - pushed.displacement()).norm() < 1e-7 * loaded.displacement().norm());

  // A correction knows them, too.
  const auto before = [&] {
    auto d = std::make_unique<ImplicitDynamics>(made(), parameters);
    d->step(0.05);
    return d;
  };
  const auto corrected = before();
  corrected->set_springs({&spring, 1});
  CHECK(corrected->correct(VectorX::Zero(load.size())));
  const auto stepped = std::make_unique<ImplicitDynamics>(made(), parameters);
  stepped->set_springs({&spring, 1});
  stepped->step(0.05);
  CHECK((corrected->displacement() - stepped->displacement()).norm() < 0.2 * stepped->displacement().norm());

  // A body that is farther away than the spring reaches is not pulled.
  pushed.set_springs(std::array{ContactSpring{spring.nodes, spring.weights, down, -0.01, 200.0}});
  for (int k = 0; k < 100; ++k) pushed.step(0.05);
  CHECK(pushed.displacement().norm() < 1e-7 * loaded.displacement().norm());
}
