// E: extremes of motion. Extremes tested with the component itself have their tag there.
#include <palpate/assembly/large_strain.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const NeoHookean jelly{3e3, 0.45, 1000.0};
using Jelly = HapticFEModel<Tet4, NeoHookean, Implicit<Newton>>;
constexpr double jelly_side = 0.1;

Mesh<Tet4> jelly_mesh(int cells = 2) {
  return box_tet4({jelly_side, jelly_side, jelly_side}, {cells, cells, cells});
}
DeformableBody jelly_body(const Scene& scene, bool small_strain = false) {
  if (small_strain) return make_deformable_body(make_body(jelly_mesh(), jelly.small_strain()), scene);
  return make_deformable_body(make_hyperelastic_body(jelly_mesh(), std::vector{jelly}), scene);
}
struct MotionSums {
  Vector3 momentum = Vector3::Zero(), spin = Vector3::Zero();
};
MotionSums sums_of(const ImplicitDynamics& d) {
  MotionSums s;
  for (Index i = 0; i < d.body().lumped.size(); ++i) {
    const Vector3 p = d.body().lumped[i] * d.velocity().segment<3>(3 * i);
    s.momentum += p;
    s.spin += (d.body().positions[static_cast<std::size_t>(i)] + d.displacement().segment<3>(3 * i)).cross(p);
  }
  return s;
}
VectorX random_velocity(const ImplicitDynamics& d, double size) {
  testing::Random random(5);
  VectorX v(d.displacement().size());
  for (double& x : v) x = random.uniform(-size, size);
  return v;
}

}  // namespace

TEST_CASE("a viscoelastic body accepts any time step", "[extreme][E1]") {
  const Viscoelastic<NeoHookean, 1> material{jelly, {{{0.5, 0.1}}}};
  for (const double h : {1e-9, 1e-6, 1e-3, 0.1, 1.0, 100.0}) {
    ImplicitDynamics d(make_deformable_body(make_hyperelastic_body(jelly_mesh(), std::vector{material}),
                                            Scene().fix("z0").gravity({9.81, 0.0, 0.0})),
                       {});
    for (int k = 0; k < 8; ++k) CHECK(d.step(h).taken);
    CHECK(d.displacement().allFinite());
    CHECK(d.displacement().norm() < 1.0);
    const VectorX u = d.displacement();
    for (const double bad : {0.0, -h, std::numeric_limits<double>::quiet_NaN(), infinity})
      CHECK_FALSE(d.step(bad).taken);
    CHECK(d.displacement() == u);
  }
}

TEST_CASE("Newmark conserves the energy at small strain over 20 000 steps, implicit Euler never gains energy",
          "[extreme][E3]") {
  for (const bool newmark : {true, false}) {
    ImplicitDynamics d(
        jelly_body(Scene(), true),
        {.scheme = newmark ? TimeScheme::newmark() : TimeScheme::implicit_euler(), .newton = {.tolerance = 1e-12}});
    d.set_state(VectorX::Zero(d.displacement().size()), random_velocity(d, 1e-3));
    const double start = d.energy();
    const Vector3 momentum = sums_of(d).momentum;
    double last = start, rise = 0.0;
    for (int k = 0; k < 20000; ++k) {
      d.step(2e-3);
      const double now = d.energy();
      rise = std::max(rise, now - last);
      last = now;
    }
    CHECK((sums_of(d).momentum - momentum).norm() <= 2e-9 * momentum.norm());  // residuals of 1e-12 accumulate
    if (newmark)
      CHECK_THAT(last, WithinRel(start, 1e-9));
    else
      CHECK(rise <= 1e-9 * start);
  }
}

TEST_CASE("a free soft body keeps its momentum, and never gains angular momentum by implicit Euler", "[extreme][E3]") {
  ImplicitDynamics d(jelly_body(Scene()), {.newton = {.tolerance = 1e-11}});
  VectorX v = random_velocity(d, 0.05);
  for (Index i = 0; i < v.size() / 3; ++i)
    v.segment<3>(3 * i) += Vector3(2.0, 1.0, 4.0).cross(d.body().positions[static_cast<std::size_t>(i)]);
  d.set_state(VectorX::Zero(v.size()), v);
  const MotionSums start = sums_of(d);
  const double energy = d.energy();
  double last = energy, rise = 0.0;
  for (int k = 0; k < 2000; ++k) {
    REQUIRE(d.step(2e-3).newton.converged);
    rise = std::max(rise, d.energy() - last);
    last = d.energy();
  }
  const MotionSums end = sums_of(d);
  CHECK((end.momentum - start.momentum).norm() <= 1e-8 * start.momentum.norm());
  CHECK(rise <= 1e-9 * energy);
  CHECK(end.spin.norm() <= start.spin.norm());
}

TEST_CASE("a sphere at rest leaves a moving tissue at rest", "[extreme][E3]") {
  Jelly tissue(box_tet4({0.06, 0.06, 0.03}, {4, 4, 2}), Scene().fix("z0").touch("z1"), jelly, {}, {.step = 0.01});
  HapticServo servo(tissue, SphereTool{.radius = 0.012});
  const auto tick = [&](int k) {
    if (k % 10 == 0) tissue.advance();
    ToolState s;
    s.time = 1e-3 * k;
    s.position = {0.03, 0.03, 0.03 + 0.012 - std::min(0.006, 2e-5 * k)};
    servo.tick({&s, 1});
  };
  for (int k = 0; k < 6000; ++k) tick(k);
  const VectorX settled = tissue.motion().displacement();
  REQUIRE(settled.norm() > 0.0);
  double off = 0.0;
  for (int k = 6000; k < 12000; ++k) {
    tick(k);
    off = std::max(off, (tissue.motion().displacement() - settled).norm() / settled.norm());
  }
  CHECK(off <= 1e-9);
}

TEST_CASE("a corotational body rotated by any angle and many times has no force", "[extreme][E4]") {
  const Corotational material{5e3, 0.45, 1000.0};
  const LargeStrain<Tet4, Corotational> body(make_hyperelastic_body(jelly_mesh(), std::vector<Corotational>{material}));
  const double h = 0.5 * jelly_side;
  VectorX u(body.size()), f(body.size());
  double worst = 0.0;
  for (const Vector3& axis : {Vector3(0, 0, 1), Vector3(1, 1, 0), Vector3(0.3, -0.8, 0.5)})
    for (int k = 0; k <= 720; ++k) {  // 20 rotations, including 180 degrees
      const Matrix3 r = Eigen::AngleAxisd(k * 3.14159265358979323846 / 18.0, axis.normalized()).toRotationMatrix();
      for (Index i = 0; i < body.mesh().node_count(); ++i)
        u.segment<3>(3 * i) = r * body.mesh().position(i) - body.mesh().position(i);
      body.force(u, f);
      worst = std::max(worst, f.norm());
    }
  CHECK(worst <= 1e-10 * 5e3 * h * h);
}

TEST_CASE("100 soft bodies with random node displacements come to rest by implicit steps", "[extreme][E5]") {
  ImplicitDynamics d(jelly_body(Scene().fix("z0")), {.mass_damping = 5.0});
  testing::Random random(23);
  int at_rest = 0, inverted = 0;
  VectorX u(d.displacement().size()), force(u.size());
  for (int run = 0; run < 100; ++run) {
    for (double& x : u) x = random.uniform(-0.02, 0.02);
    d.set_state(u, VectorX::Zero(u.size()));
    inverted += d.body().elastic->force(u, force).inverted > 0 ? 1 : 0;
    for (int k = 0; k < 600 && (k < 20 || d.kinetic_energy() > 1e-14); ++k) {
      d.step(0.02);
      REQUIRE(d.displacement().allFinite());
    }
    at_rest += d.kinetic_energy() <= 1e-14 ? 1 : 0;
  }
  CHECK(at_rest == 100);
  CHECK(inverted > 25);
}

TEST_CASE("a motion with loads that are not finite keeps its state and reports a step not taken", "[extreme][E6]") {
  ImplicitDynamics d(jelly_body(Scene().fix("z0").gravity({0.0, 0.0, -9.81})), {});
  for (int k = 0; k < 5; ++k) REQUIRE(d.step(0.01).taken);
  const VectorX u = d.displacement(), v = d.velocity(), load = d.body().load;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    d.set_load(VectorX::Constant(u.size(), bad));
    CHECK_FALSE(d.step(0.01).taken);
    CHECK(d.displacement() == u);
    CHECK(d.velocity() == v);
  }
  d.set_load(VectorX::Constant(u.size(), 1e308));  // finite, but its square is not
  const StepReport report = d.step(0.01);
  CHECK((!report.taken || !report.newton.converged));
  REQUIRE(d.displacement().allFinite());
  REQUIRE(d.velocity().allFinite());
  d.set_state(u, v);
  d.set_load(load);
  CHECK(d.step(0.01).taken);
}

TEST_CASE("artificial energy is reported, and nothing else", "[extreme][E6]") {
  const auto run = [](const TimeScheme& scheme, double young, double nu, double h) {
    const NeoHookean material{young, nu, 1000.0};
    ImplicitDynamics d(make_deformable_body(make_hyperelastic_body(box_tet4({0.1, 0.1, 0.1}, {2, 2, 2}, BoxSplit::six),
                                                                   std::vector{material}),
                                            Scene().fix("z0").gravity({9.81, 0.0, 0.0})),
                       {.scheme = scheme});
    double most_work = 0.0, most_energy = 0.0;
    int reported = 0;
    for (int k = 0; k < 100; ++k) {
      const StepReport report = d.step(h);
      REQUIRE(report.taken);
      most_work = std::max(most_work, std::abs(d.body().load.dot(d.displacement())));
      most_energy = std::max(most_energy, d.kinetic_energy() + d.elastic_energy());
      if (!report.energy_bounded) ++reported;
      if (reported == 0) CHECK(most_energy <= 10.0 * most_work);
    }
    return std::pair(reported, most_energy / most_work);
  };
  // Newmark at large strain, steps of a hundred periods of the body.
  const auto [reported, energy] = run(TimeScheme::newmark(), 1e4, 0.4999, 0.0316);
  CHECK(reported > 0);
  CHECK(energy > 10.0);
  for (double h : {1e-6, 1e-3, 0.03, 1.0})
    for (double young : {1e3, 1e5, 1e8}) {
      INFO(h << " s, " << young << " Pa");
      CHECK(run(TimeScheme::implicit_euler(), young, 0.45, h).first == 0);
      if (h <= 1e-3) CHECK(run(TimeScheme::newmark(), young, 0.45, h).first == 0);
    }
}

TEST_CASE("a motion that decays leaves no denormal numbers", "[extreme][E8]") {
  Jelly tissue(box_tet4({0.02, 0.02, 0.02}, {1, 1, 1}), Scene().fix("z0").touch("z1"), jelly, {},
               {.step = 0.05, .mass_damping = 50.0});
  const VertexForce push{0, {0.0, 0.0, -1e-3}};
  tissue.end_tick({&push, 1});
  tissue.advance();
  tissue.end_tick({});
  REQUIRE(tissue.motion().displacement().norm() > 0.0);
  for (int k = 0; k < 5000; ++k) tissue.advance();
  for (const VectorX& x : {tissue.motion().displacement(), tissue.motion().velocity()})
    for (const double value : x) CHECK(std::fpclassify(value) != FP_SUBNORMAL);
}
