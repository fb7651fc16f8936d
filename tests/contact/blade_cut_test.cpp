// Force and work of a sharp cut.
#include <palpate/contact/detail/blade_cut.hpp>
#include <palpate/testing/random.hpp>

#include "refused.hpp"

#include "catch.hpp"

using namespace palpate;

TEST_CASE("the work of cutting is toughness times area", "[contact][blade]") {
  constexpr double stiffness = 400.0;
  BladeCut blade({.toughness = 200.0}, stiffness);
  double work = 0.0;
  Vector3 hand(0, 0, 0), last = hand;
  blade.advance(hand, 0.0);
  Vector3 force = Vector3::Zero();
  for (int i = 0; i < 20000; ++i) {
    hand[2] -= 1e-6;
    const Vector3 now = blade.advance(hand, 0.01);
    work -= 0.5 * (force + now).dot(hand - last);  // work of the hand; the force is linear or constant in a step
    force = now;
    last = hand;
  }
  const double hold = 200.0 * 0.01 / stiffness;
  CHECK(std::abs(force.norm() - 2.0) < 1e-12);  // 200 J/m^2 x 10 mm
  CHECK(std::abs(blade.area() - 0.01 * (0.02 - hold)) < 1e-12);
  CHECK(std::abs(blade.work() - 200.0 * blade.area()) < 1e-12);    // of 0.04 J
  CHECK(std::abs(work - blade.work() - 0.5 * 2.0 * hold) < 1e-6);  // the rest is stored in the coupling
  // Backward motion is free, and so is motion where it has cut before.
  for (int i = 0; i < 2000; ++i) CHECK(std::abs(blade.advance(hand += Vector3(0, 0, 1e-5), 0.01)[2]) < 2.0 + 1e-12);
  CHECK(blade.advance(hand, 0.01).norm() < 1e-9);
  const double area = blade.area();
  for (int i = 0; i < 400; ++i) blade.advance(hand -= Vector3(0, 0, 1e-5), 0.01);
  CHECK(blade.area() == area);
}

TEST_CASE("no motion of the hand gains energy from a blade", "[contact][blade]") {
  BladeCut blade({.toughness = 150.0}, 400.0);
  testing::Random random(4);
  Vector3 hand = Vector3::Zero();
  blade.advance(hand, 0.01);
  double in = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 step = 2e-4 * random.vector<3>(-1, 1);
    hand += step;
    in -= blade.advance(hand, i % 50 < 40 ? 0.01 : 0.0).dot(step);  // with the force at the end of the step
    REQUIRE(in > -1e-12);
  }
}

TEST_CASE("a blade after reset behaves as a new one", "[contact][blade]") {
  BladeCut used({.toughness = 150.0}, 400.0), fresh({.toughness = 150.0}, 400.0);
  testing::Random random(9);
  for (int i = 0; i < 100; ++i) used.advance(1e-3 * random.vector<3>(-1, 1), 0.01);
  used.reset();
  Vector3 hand = Vector3::Zero();
  for (int i = 0; i < 200; ++i) {
    hand += 2e-4 * random.vector<3>(-1, 1);
    CHECK((used.advance(hand, 0.01) == fresh.advance(hand, 0.01)));
  }
  CHECK(used.area() == fresh.area());
  CHECK(used.work() == fresh.work());
}

TEST_CASE("invalid blades are refused", "[contact][blade]") {
  constexpr auto bad = SetupErrorKind::bad_argument;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double stiffness : {0.0, -1.0, nan, infinity}) CHECK_REFUSED(bad, BladeCut({}, stiffness));
  for (const double value : {0.0, -1.0, nan, infinity}) CHECK_REFUSED(bad, BladeCut({.cut_spacing = value}, 400.0));
  for (const double value : {-1.0, nan, infinity}) CHECK_REFUSED(bad, BladeCut({.toughness = value}, 400.0));
  CHECK_REFUSED(bad, BladeCut({.edge = Vector3::Zero()}, 400.0));
  CHECK_REFUSED(bad, BladeCut({.forward = Vector3::Zero()}, 400.0));
  CHECK_REFUSED(bad, BladeCut({.edge = {0.0, 0.0, 0.01}}, 400.0));  // parallel to forward: it would sweep no area
}
