#include <palpate/cut/blade.hpp>
#include <palpate/cut/cuttable_tissue.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;

TEST_CASE("cutting takes toughness times area", "[cut][blade]") {
  const BladeParameters p{.toughness = 200.0};
  BladeCut blade(p);
  double work = 0.0;
  Vector3 hand(0, 0, 0), last = hand;
  blade.advance(hand, 0.0);
  Vector3 force = Vector3::Zero();
  for (int i = 0; i < 20000; ++i) {
    hand[2] -= 1e-6;
    const Vector3 now = blade.advance(hand, 0.01);
    work -= 0.5 * (force + now).dot(hand - last);  // by the hand; the force is linear in between or constant
    force = now;
    last = hand;
  }
  const double hold = 200.0 * 0.01 / p.stiffness;
  CHECK(std::abs(force.norm() - 2.0) < 1e-12);  // 200 J/m^2 x 10 mm
  CHECK(std::abs(blade.area() - 0.01 * (0.02 - hold)) < 1e-12);
  CHECK(std::abs(blade.work() - 200.0 * blade.area()) < 1e-12);    // of 0.04 J
  CHECK(std::abs(work - blade.work() - 0.5 * 2.0 * hold) < 1e-6);  // the rest is in the coupling
  // Back is free, and so is what was cut before.
  for (int i = 0; i < 2000; ++i) CHECK(std::abs(blade.advance(hand += Vector3(0, 0, 1e-5), 0.01)[2]) < 2.0 + 1e-12);
  CHECK(blade.advance(hand, 0.01).norm() < 1e-9);
  const double area = blade.area();
  for (int i = 0; i < 400; ++i) blade.advance(hand -= Vector3(0, 0, 1e-5), 0.01);
  CHECK(blade.area() == area);
}

TEST_CASE("no motion of the hand gains energy of a blade", "[cut][blade]") {
  BladeCut blade({.toughness = 150.0});
  testing::Random random(4);
  Vector3 hand = Vector3::Zero();
  blade.advance(hand, 0.01);
  double in = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 step = 2e-4 * random.vector<3>(-1, 1);
    hand += step;
    in -= blade.advance(hand, i % 50 < 40 ? 0.01 : 0.0).dot(step);  // of the force at the end of the step
    REQUIRE(in > -1e-12);
  }
}

TEST_CASE("a blade opens the tissue it is pushed into, and is felt", "[cut][blade][extreme][F3]") {
  const auto mesh = box_tet4({0.06, 0.04, 0.03}, {9, 6, 5}, BoxSplit::six);
  CuttableTissue<Tet4> tissue(mesh, Scene().fix("z0").touch("z1"),
                              LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0});
  const ForceLimits limits;
  BladeServo servo(tissue, {.edge = {0.0, 0.05, 0.0}, .toughness = 40.0}, limits);
  Vector3 last = Vector3::Zero();
  double most = 0.0;
  const int vertices = tissue.contact_surface().vertex_count();
  for (int i = 0; i < 400; ++i) {
    ToolState s;
    s.position = {0.0301, 0.02, 0.035 - 1e-4 * i * 0.5};
    s.time = 1e-3 * i;
    const testing::AllocationScope scope;
    const GatedForce f = servo.tick(s);
    const auto calls = scope.allocations() + scope.frees();
    REQUIRE(calls == 0);
    REQUIRE(f.force().allFinite());
    REQUIRE((f.force() - last).norm() <= limits.slew_rate * limits.period * (1.0 + 1e-9));
    last = f.force();
    most = std::max(most, last.norm());
    if (i % 16 == 0) tissue.work();
  }
  tissue.work();
  tissue.begin_tick();
  CHECK(most > 0.5);
  CHECK(most <= 40.0 * 0.05 + 1e-9);
  CHECK(servo.blade().area() > 0.0);
  CHECK(tissue.report().cuts > 1);
  CHECK(tissue.contact_surface().vertex_count() > vertices);
  CHECK_REFUSED(SetupErrorKind::bad_argument, BladeCut({.stiffness = 0.0}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, BladeCut({.edge = Vector3::Zero()}));
}
