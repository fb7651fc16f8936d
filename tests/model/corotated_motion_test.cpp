// Matrix-free implicit steps against fully converged steps, conservation laws and equilibrium.
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/detail/corotated_motion.hpp>
#include <palpate/model/moving/implicit_dynamics.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;

namespace {

using Elastic = Corotational;

HyperelasticBody<Tet4, Elastic> pad(double poisson_ratio = 0.4) {
  return make_hyperelastic_body(box_tet4({0.04, 0.04, 0.08}, {2, 2, 4}),
                                std::vector<Elastic>{{5e3, poisson_ratio, 1000.0}});
}
/// Fixed at the bottom, under its own weight.
Scene standing() {
  Scene scene;
  scene.fix("z0").gravity({0.0, 0.0, -9.81});
  return scene;
}
detail::CorotatedMotionOptions to_the_end(TimeScheme scheme = TimeScheme::implicit_euler()) {
  detail::CorotatedMotionOptions options;
  options.scheme = scheme;
  options.solve = {2000, 1e-13};
  return options;
}
using Exact = detail::CorotatedMotion<double>;

Vector3 momentum_of(const Exact& m) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < m.body().lumped.size(); ++i) sum += m.body().lumped[i] * m.velocity().segment<3>(3 * i);
  return sum;
}
double stored(const HyperelasticBody<Tet4, Elastic>& body, const VectorX& u) {
  return LargeStrain<Tet4, Elastic>(body).energy(u);
}
/// A bend that grows with height [m].
VectorX bent(const Exact& m, double amount) {
  VectorX u = VectorX::Zero(m.size());
  for (Index i = 0; i < u.size() / 3; ++i) {
    const double z = m.body().positions[static_cast<std::size_t>(i)].z();
    u[3 * i] = amount * z * z;
  }
  return u;
}

/// Largest distance of two motions over all steps, relative to the largest displacement.
template <class Motion>
double apart_on_the_path(Motion& motion, ImplicitDynamics& reference, double h, int steps) {
  double apart = 0.0, largest = 0.0;
  for (int k = 0; k < steps; ++k) {
    REQUIRE(motion.step(h).taken);
    REQUIRE(reference.step(h).newton.converged);
    apart = std::max(apart, (motion.displacement() - reference.displacement()).norm());
    largest = std::max(largest, reference.displacement().norm());
  }
  return apart / largest;
}

}  // namespace

TEST_CASE("one linearisation per step follows the converged steps, closer with shorter steps", "[model][corotated]") {
  for (const TimeScheme& scheme : {TimeScheme::implicit_euler(), TimeScheme::newmark()}) {
    double error[2];
    for (int fine = 0; fine < 2; ++fine) {
      Exact motion(pad(), standing(), to_the_end(scheme));
      ImplicitDynamics reference(make_deformable_body(pad(), standing()), {.scheme = scheme});
      const double h = fine ? 1e-3 : 2e-3;
      const VectorX u = bent(motion, 4.0), v = VectorX::Zero(u.size());
      motion.set_state(u, v);
      reference.set_state(u, v);
      error[fine] = apart_on_the_path(motion, reference, h, fine ? 80 : 40);
    }
    INFO("errors " << error[0] << ", " << error[1]);
    CHECK(error[0] <= 5e-3);
    CHECK(error[1] <= 0.5 * error[0]);
  }
}

TEST_CASE("single precision with a tolerance of one percent stays close to the reference", "[model][corotated]") {
  detail::CorotatedMotionOptions options;
  options.solve.tolerance = 1e-2;
  detail::CorotatedMotion<float> motion(pad(), standing(), options);
  Exact reference(pad(), standing(), to_the_end());
  double apart = 0.0;
  for (int k = 0; k < 200; ++k) {
    const detail::CorotatedStep step = motion.step(1e-3);
    REQUIRE(step.taken);
    CHECK(step.solve.converged);
    REQUIRE(reference.step(1e-3).taken);
    apart = std::max(apart, (motion.displacement() - reference.displacement()).norm());
  }
  CHECK(apart <= 5e-3 * reference.displacement().norm());
}

TEST_CASE("the motion settles in the equilibrium for any step and preconditioner", "[model][corotated]") {
  ImplicitDynamics reference(make_deformable_body(pad(), standing()), {.mass_damping = 20.0});
  for (int k = 0; k < 200; ++k) reference.step(0.05);
  const auto settles = [&](auto&& motion, double h, double tolerance) {
    for (int k = 0; k * h < 8.0; ++k) motion.step(h);
    CHECK((motion.displacement() - reference.displacement()).norm() <= tolerance * reference.displacement().norm());
  };
  detail::CorotatedMotionOptions options;
  options.mass_damping = 20.0;
  options.solve.tolerance = 1e-2;
  settles(Exact(pad(), standing(), options), 1e-2, 1e-9);
  settles(detail::CorotatedMotion<float>(pad(), standing(), options), 1e-2, 1e-4);
  settles(detail::CorotatedMotion<double, CorotatedFactor>(pad(), standing(), options), 5e-2, 1e-9);
  options.stiffness_damping = 1e-2;
  settles(Exact(pad(), standing(), options), 2e-3, 1e-9);
}

TEST_CASE("a free body keeps its momentum", "[model][corotated]") {
  Exact motion(pad(), Scene(), to_the_end());
  testing::Random random(4);
  VectorX v(motion.size());
  for (double& x : v) x = random.uniform(-0.5, 0.5);
  motion.set_state(VectorX::Zero(v.size()), v);
  const Vector3 before = momentum_of(motion);
  for (int k = 0; k < 500; ++k) {
    const detail::CorotatedStep step = motion.step(1e-3);
    REQUIRE(step.taken);
    CHECK(step.linearisations == 1);
  }
  CHECK((momentum_of(motion) - before).norm() <= 1e-12 * before.norm());
}

TEST_CASE("implicit Euler never adds energy, from any state", "[model][corotated][E1][E5]") {
  testing::Random random(11);
  for (const double h : {1e-5, 1e-3, 0.03, 1.0})
    for (const double amount : {0.002, 0.02, 0.08}) {
      Exact motion(pad(0.45), Scene(), to_the_end());
      VectorX u(motion.size());
      for (double& x : u) x = random.uniform(-amount, amount);
      motion.set_state(u, VectorX::Zero(u.size()));
      double energy = stored(pad(0.45), u), start = energy;
      INFO("step " << h << ", random displacements up to " << amount);
      for (int k = 0; k < 40; ++k) {
        const detail::CorotatedStep step = motion.step(h);
        REQUIRE(step.taken);
        CHECK(step.energy_bounded);
        const double now = stored(pad(0.45), motion.displacement()) + motion.kinetic_energy();
        CHECK(now <= energy + 1e-12 * start);
        energy = now;
      }
    }
}

TEST_CASE("bodies with random displacements settle without inverted elements", "[model][corotated][E5]") {
  testing::Random random(12);
  detail::CorotatedMotionOptions options;
  options.mass_damping = 5.0;
  detail::CorotatedMotion<float> motion(pad(), standing(), options);
  int upright = 0;
  for (int run = 0; run < 20; ++run) {
    VectorX u(motion.size());
    for (double& x : u) x = random.uniform(-0.01, 0.01);  // half of a cell
    motion.set_state(u, VectorX::Zero(u.size()));
    detail::CorotatedStep last;
    for (int k = 0; k < 300; ++k) last = motion.step(1e-2);
    CHECK(motion.displacement().allFinite());
    upright += last.deformation.inverted == 0 ? 1 : 0;
  }
  CHECK(upright == 20);
}

TEST_CASE("a pad pressed by two fifths of its height keeps all elements upright", "[model][corotated][E5]") {
  for (const double nu : {0.45, 0.49}) {
    const Mesh<Tet4> mesh = box_tet4({0.06, 0.06, 0.03}, {8, 8, 4});
    std::vector<NodeId> patch;
    for (Index i = 0; i < mesh.node_count(); ++i)
      if (mesh.position(i).z() > 0.029 && (mesh.position(i) - Vector3(0.03, 0.03, 0.03)).norm() < 0.008)
        patch.push_back(static_cast<NodeId>(i));
    detail::CorotatedMotionOptions options;
    options.mass_damping = 20.0;
    detail::CorotatedMotion<float> motion(make_hyperelastic_body(mesh, std::vector<Elastic>{{5e3, nu, 1000.0}}),
                                          Scene().fix("z0").fix(patch), options);
    VectorX prescribed = VectorX::Zero(motion.size());
    double smallest = 1.0;
    for (int k = 1; k <= 1000; ++k) {  // 13 mm within 0.65 s
      for (const NodeId i : patch) prescribed[3 * Index{i} + 2] = -2e-5 * std::min(k, 650);
      motion.set_prescribed(prescribed);
      const detail::CorotatedStep step = motion.step(1e-3);
      REQUIRE(step.taken);
      CHECK(step.residual <= 0.01);
      smallest = std::min(smallest, step.deformation.smallest_volume_ratio);
    }
    INFO("nu = " << nu);
    CHECK(smallest > 0.1);
  }
}

TEST_CASE("a correction gives the result of the step with the force", "[model][corotated]") {
  Exact first(pad(), standing(), to_the_end()), second(pad(), standing(), to_the_end());
  VectorX more = VectorX::Zero(first.size());
  more[more.size() - 1] = 1e-4;
  first.step(1e-3);
  first.correct(more);
  second.set_load(second.body().load + more);
  second.step(1e-3);
  CHECK((first.displacement() - second.displacement()).norm() <= 1e-9 * second.displacement().norm());
  CHECK((first.velocity() - second.velocity()).norm() <= 1e-9 * second.velocity().norm());

  VectorX u(more.size());
  REQUIRE(second.prepare_response(1e-3));
  second.respond(more, u);
  CHECK(u.dot(more) > 0.0);
  const VectorX before = second.displacement();
  second.correct(more);  // no step since
  CHECK(second.displacement() == before);
}

TEST_CASE("prescribed nodes follow their values, and the others follow them", "[model][corotated]") {
  Scene scene;
  scene.fix("z0").fix("z1");
  Exact motion(pad(), scene, to_the_end());
  const VectorX still = motion.body().conditions.prescribed;
  VectorX target = still;
  for (Index i = 0; i < target.size() / 3; ++i)
    if (motion.body().positions[static_cast<std::size_t>(i)].z() > 0.079) target[3 * i + 2] = 0.008;  // 10 % longer
  for (int k = 1; k <= 2000; ++k) {
    motion.set_prescribed(still + std::min(1.0, k / 100.0) * (target - still));
    REQUIRE(motion.step(5e-3).taken);
  }
  const VectorX f = motion.resistance();
  double up = 0.0, down = 0.0;
  for (Index i = 0; i < f.size() / 3; ++i) {
    const double z = motion.body().positions[static_cast<std::size_t>(i)].z();
    if (z > 0.079) up += f[3 * i + 2];
    if (z < 0.001) down += f[3 * i + 2];
    if (z > 0.001 && z < 0.079) CHECK(f.segment<3>(3 * i).norm() <= 1e-10);
  }
  CHECK_THAT(up + down, WithinAbs(0.0, 1e-10));
  CHECK(up > 5e3 * 0.0016 * 0.1);  // E A e, more where the ends cannot narrow
  CHECK(up < 1.3 * 5e3 * 0.0016 * 0.1);
}

TEST_CASE("invalid steps change nothing", "[model][corotated][E1]") {
  Exact motion(pad(), standing());
  motion.step(1e-3);
  const VectorX u = motion.displacement(), v = motion.velocity();
  for (const double h : {0.0, -1e-3, std::nan(""), infinity}) CHECK_FALSE(motion.step(h).taken);
  VectorX load = VectorX::Zero(u.size());
  load[5] = std::nan("");
  motion.set_load(load);
  CHECK_FALSE(motion.step(1e-3).taken);
  CHECK(motion.displacement() == u);
  CHECK(motion.velocity() == v);
  motion.set_load(motion.body().load);
  CHECK(motion.step(1e-9).taken);
  CHECK(motion.step(1.0).taken);
}

TEST_CASE("co-rotated steps do not allocate", "[model][corotated]") {
  detail::CorotatedMotion<float> motion(pad(), standing());
  detail::CorotatedMotion<double, CorotatedFactor> rotated(pad(), standing());
  const VectorX load = motion.body().load;
  const testing::AllocationScope scope;
  for (int k = 0; k < 20; ++k) {
    motion.step(1e-3);
    motion.correct(load);
    rotated.step(1e-2);
  }
  CHECK(scope.allocations() == 0);
}

TEST_CASE("co-rotated motion refuses what it cannot do", "[model][corotated]") {
  const auto kind = [](const HyperelasticBody<Tet4, Elastic>& body, const Scene& scene,
                       detail::CorotatedMotionOptions options) {
    try {
      Exact(body, scene, options);
    } catch (const SetupError& e) {
      return std::string(to_string(e.kind()));
    }
    return std::string("accepted");
  };
  CHECK(kind(pad(), standing(), {}) == "accepted");
  for (const double bad : {-1.0, infinity, std::nan("")}) {
    CHECK(kind(pad(), standing(), {.mass_damping = bad}) == "bad_argument");
    CHECK(kind(pad(), standing(), {.stiffness_damping = bad}) == "bad_argument");
    CHECK(kind(pad(), standing(), {.solve = {10, bad == infinity ? -infinity : bad}}) == "bad_argument");
  }
  CHECK(kind(pad(), standing(), {.scheme = TimeScheme::newmark(0.0)}) == "bad_argument");
  CHECK(kind(pad(), standing(), {.solve = {0, 1e-3}}) == "bad_argument");
  CHECK(kind(pad(), standing(), {.precondition_every = 0}) == "bad_argument");
  auto weightless = pad();
  weightless.rest.density[0] = 0.0;
  CHECK(kind(weightless, standing(), {}) == "bad_density");
}

TEST_CASE("a correction that did not converge is not applied", "[model][corotated]") {
  detail::CorotatedMotionOptions options;
  options.solve.maximum_iterations = 1;
  detail::CorotatedMotion<double> motion(pad(), standing(), options);
  REQUIRE(motion.step(1e-2).taken);
  const VectorX u = motion.displacement(), load = motion.body().load;
  CHECK_FALSE(motion.correct(load));
  CHECK(motion.displacement() == u);
}

TEST_CASE("the relative residual is zero at rest and at most one with strong damping", "[model][corotated]") {
  Scene scene;
  scene.fix("z0");
  detail::CorotatedMotion<> still(pad(), scene);
  CHECK(still.step(1e-3).residual == 0.0);
  detail::CorotatedMotionOptions options;
  options.mass_damping = 1e5;
  detail::CorotatedMotion<> damped(pad(), standing(), options);
  damped.set_state(damped.displacement(), VectorX::Constant(damped.size(), 1.0));
  for (int k = 0; k < 5; ++k) CHECK(damped.step(1e-3).residual <= 1.0);
}

TEST_CASE("a refused step does not affect the next step", "[model][corotated][E6]") {
  detail::CorotatedMotionOptions options = to_the_end();
  options.stiffness_damping = 1e-3;
  Exact motion(pad(), standing(), options), same(pad(), standing(), options);
  for (int k = 0; k < 10; ++k)
    for (Exact* m : {&motion, &same}) REQUIRE(m->step(5e-3).taken);
  const VectorX good = VectorX::Zero(motion.size());
  motion.set_prescribed(VectorX::Constant(motion.size(), std::numeric_limits<double>::quiet_NaN()));
  REQUIRE_FALSE(motion.step(5e-3).taken);
  motion.set_prescribed(good);
  const detail::CorotatedStep a = motion.step(5e-3), b = same.step(5e-3);
  CHECK(a.energy_bounded);
  CHECK(a.linearisations == b.linearisations);
  CHECK((motion.displacement() - same.displacement()).norm() <= 1e-10 * same.displacement().norm());
  CHECK_REFUSED(SetupErrorKind::bad_argument, motion.set_load(good.head(3)));
  CHECK_REFUSED(SetupErrorKind::bad_argument, motion.set_prescribed(good.head(3)));
  CHECK_REFUSED(SetupErrorKind::bad_argument, motion.set_state(good, good.head(3)));
}
