// Force and work of a sharp cut.
#include <palpate/contact/blade_cut.hpp>
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

TEST_CASE("the work of cutting is toughness times area in every direction across the edge", "[contact][blade]") {
  constexpr double stiffness = 400.0, toughness = 200.0, width = 0.01, hold = toughness * width / stiffness;
  testing::Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3 edge = width * random.vector<3>(-1, 1).normalized();
    BladeCut blade({.edge = edge, .toughness = toughness}, stiffness);
    Vector3 hand = random.vector<3>(-1, 1);
    const Vector3 along = edge.normalized();
    const Vector3 ahead = random.vector<3>(-1, 1), draw = 0.01 * random.uniform(-1, 1) * along;
    const Vector3 across = 0.02 * (ahead - ahead.dot(along) * along).normalized();
    blade.advance(hand, 0.0);
    const auto move = [&](const Vector3& by) {
      for (int k = 0; k < 2000; ++k) blade.advance(hand += by / 2000.0, width);
    };
    const auto has_cut = [&](double path) { return std::abs(blade.area() - width * path) < 1e-9; };
    if (trial % 2 == 0) {
      move(across + draw);  // press and draw
      CHECK(has_cut(0.02 - hold));
      move(-draw);  // draw alone
      CHECK(has_cut(0.02 - hold));
    } else {
      move(across);
      CHECK(has_cut(0.02 - hold));
      move(-across);  // back
      CHECK(has_cut(0.02 - hold));
      CHECK(blade.advance(hand, width).norm() < 1e-9);
      move(across);  // again
      CHECK(has_cut(0.02 - hold));
    }
    const double area = blade.area();
    move(2.0 * cross(along, across));  // sideways
    CHECK(blade.area() - area > width * (0.04 - hold));
    CHECK(blade.area() - area < width * 0.04);
    CHECK(std::abs(blade.work() - toughness * blade.area()) < 1e-12);
    CHECK(blade.advance(hand, width).norm() == Catch::Approx(toughness * width));
  }
}

TEST_CASE("a blade pays for every parallel slit, once", "[contact][blade]") {
  BladeCut blade({.edge = {0.0, 0.02, 0.0}, .toughness = 100.0}, 400.0);
  const double hold = 100.0 * 0.02 / 400.0;
  double expected = 0.0;
  const auto press = [&](double x, double y) {
    for (const int way : {-1, 1})
      for (int k = 0; k < 1000; ++k) {
        const double z = way < 0 ? -2e-5 * k : -0.02 + 2e-5 * k;
        blade.advance({x, y, z + 0.001}, z < -0.001 ? 0.02 : 0.0);
      }
    blade.advance({x, y, 0.01}, 0.0);
  };
  for (const double x : {0.0, 0.003, -0.003}) {
    press(x, 0.0);
    expected += 0.02 * (0.019 - hold);
    CHECK(blade.area() == Catch::Approx(expected).epsilon(0.02));
    press(x, 0.0);
    press(x + 4e-4, 0.0);  // less than the cut spacing beside it
    CHECK(blade.area() == Catch::Approx(expected).epsilon(0.02));
  }
  press(0.0, 0.005);  // a quarter of the edge is outside the slit
  CHECK(blade.area() > expected + 0.2 * 0.02 * (0.019 - hold));
  CHECK(blade.area() < expected + 0.35 * 0.02 * 0.019);
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
}
