// The simulated device compared with closed forms: mechanics, electronics, and the two theoretical limits of stiffness.
#include <palpate/testing/device_laws.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/stability.hpp>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using palpate::testing::gated;
using palpate::testing::VirtualWall;

namespace {

/// Without friction and encoder steps the loop is linear.
SimulatedOptions linear(double mass = 0.1, double damping = 0.3) {
  SimulatedOptions o;
  o.mass = mass;
  o.damping = damping;
  o.friction = o.encoder_step = 0.0;
  o.limits.peak_force = 1e3;
  return o;
}

SimulatedDevice started(const SimulatedOptions& options) {
  SimulatedDevice device(options);
  device.start();
  return device;
}

void run(SimulatedDevice& device, int ticks) {
  for (int i = 0; i < ticks; ++i) device.read();
}

}  // namespace

TEST_CASE("a handle in a hand follows the damped oscillator", "[device][simulated]") {
  for (double damping : {0.0, 0.4, 6.0, 40.0}) {  // undamped, underdamped, overdamped
    SimulatedOptions o = linear(0.1, 0.25 * damping);
    o.rate = GENERATE(1000.0, 3.0);
    o.hand = {.mass = 0.2, .damping = 0.75 * damping, .stiffness = 60.0};
    SimulatedDevice device(o);
    device.push(Vector3(0.0, 0.6, 0.0));  // rests at 10 mm
    const double m = 0.3, a = damping / (2.0 * m), w2 = 60.0 / m - a * a, w = std::sqrt(std::abs(w2));
    for (int i = 0; i < 20; ++i) {
      const double t = device.read().time;
      const double c = w2 > 0.0 ? std::cos(w * t) : std::cosh(w * t);
      const double s = w2 > 0.0 ? std::sin(w * t) / w : std::sinh(w * t) / w;
      INFO("damping " << damping << " t " << t);
      CHECK_THAT(device.position()[1], WithinAbs(0.01 * (1.0 - std::exp(-a * t) * (c + a * s)), 1e-13));
      CHECK_THAT(device.velocity()[1], WithinAbs(0.01 * std::exp(-a * t) * s * (60.0 / m), 1e-12));
    }
  }
}

TEST_CASE("Coulomb friction sticks, slides and stops as in the closed form", "[device][simulated]") {
  SimulatedOptions o = linear(0.1, 0.0);
  o.friction = 0.3;
  SimulatedDevice device(o);
  device.push(Vector3(0.1, -0.2, 0.19));  // 0.293 N
  run(device, 1000);
  CHECK(device.position().norm() < 1e-20);
  const Vector3 direction = Vector3(2.0, 0.0, -1.0).normalized();
  device.push(0.5 * direction);
  run(device, 100);  // (0.5 - 0.3) N on 0.1 kg: 2 m/s^2
  CHECK_THAT(device.velocity().norm(), WithinRel(0.2, 1e-9));
  CHECK_THAT(device.position().norm(), WithinRel(0.01, 1e-9));
  CHECK_THAT(device.position().dot(direction), WithinRel(0.01, 1e-9));
  device.push(Vector3::Zero());  // 3 m/s^2 against 0.2 m/s: stops after 0.2^2 / 6 m
  run(device, 200);
  CHECK(device.velocity() == Vector3::Zero());
  CHECK_THAT(device.position().norm(), WithinAbs(0.01 + 0.04 / 6.0, 1e-8));
  CHECK_THAT(device.energy().friction, WithinRel(-0.3 * device.position().norm(), 1e-3));
}

TEST_CASE("energy is conserved through motors, hand, friction and dampers", "[device][simulated]") {
  testing::Random random(4);
  for (double friction : {0.0, 0.2}) {
    SimulatedOptions o = linear(0.1, 0.3);
    o.friction = friction;
    o.delay = 0.7e-3;
    o.hand = SimulatedHand::firm();
    SimulatedDevice device = started(o);
    for (int i = 0; i < 2000; ++i) {
      device.read();
      if (i % 50 == 0) device.push(random.vector<3>(-5.0, 5.0));
      device.write(gated(random.vector<3>(-2.0, 2.0)));
    }
    const SimulatedEnergy& e = device.energy();
    const double kinetic = 0.5 * 0.1 * device.velocity().squaredNorm();
    CHECK_THAT(e.motors + e.hand + e.friction + e.viscous, WithinAbs(kinetic, 1e-12));
    CHECK(e.viscous < -1e-3);
    if (friction > 0.0) CHECK(e.friction < -1e-3);
    if (friction <= 0.0) CHECK(e.friction == 0.0);
  }
}

TEST_CASE("the dissipation of the dampers equals the closed form", "[device][simulated]") {
  SimulatedOptions o = linear(0.1, 0.3);
  o.hand = {.mass = 0.0, .damping = 0.1, .stiffness = 0.0};
  SimulatedDevice device(o);
  device.push(Vector3(2.0, 0.0, 0.0));  // terminal velocity 2 / 0.4 = 5 m/s
  run(device, 3000);
  const double before = device.energy().viscous, hand = device.energy().hand;
  run(device, 1000);
  CHECK_THAT(device.energy().viscous - before, WithinRel(-0.3 * 25.0, 1e-4));
  CHECK_THAT(device.energy().hand - hand, WithinRel(0.3 * 25.0, 1e-4));  // its push minus its own damper
}

TEST_CASE("a force acts exactly after the delay", "[device][simulated]") {
  for (double delay : {0.0, 0.4e-3, 1e-3, 2.5e-3, 32e-3}) {
    SimulatedOptions o = linear(0.1, 0.0);
    o.delay = delay;
    SimulatedDevice device = started(o);
    run(device, 5);
    for (int i = 0; i < 60; ++i) {
      device.write(gated(Vector3(0.0, 0.0, 0.5)));  // from t = 5 ms + delay on
      device.read();
      const double t = std::max(0.0, device.time() - 5e-3 - delay);
      CHECK_THAT(device.position()[2], WithinAbs(2.5 * t * t, 1e-15));
    }
  }
}

TEST_CASE("positions are rounded to encoder steps", "[device][simulated]") {
  SimulatedOptions o = linear();
  o.encoder_step = 55e-6;
  SimulatedDevice device(o);
  device.push(Vector3(0.1, -0.07, 0.03));
  for (int i = 0; i < 300; ++i) {
    const Vector3 x = device.read().position;
    CHECK((x - device.position()).cwiseAbs().maxCoeff() <= 27.5e-6 * (1.0 + 1e-9));
    CHECK(((x / 55e-6).array() - (x / 55e-6).array().round()).abs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("jitter and stalls make reads late, never early, and do not change the grid", "[device][simulated]") {
  SimulatedOptions o = linear();
  o.jitter = 0.8e-3;
  o.stall = 5.3e-3;
  o.stall_interval = 0.05;
  SimulatedDevice device(o);
  double before = 0.0, latest = 0.0, mean = 0.0;
  int stalls = 0, on_grid = 0;
  for (int i = 0; i < 20000; ++i) {
    const double t = device.read().time;
    REQUIRE(t > before);
    if (t - before > 4e-3)
      ++stalls;
    else {
      const double late = t - 1e-3 * std::floor(t / 1e-3 + 1e-6);
      latest = std::max(latest, late);
      mean += late;
      ++on_grid;
    }
    before = t;
  }
  CHECK(latest <= 0.8e-3 + 1e-9);
  CHECK(latest > 0.79e-3);
  CHECK_THAT(mean / on_grid, WithinAbs(0.4e-3, 0.02e-3));
  // One per 50 ms plus its own length; each covers 5 or 6 reads.
  CHECK_THAT(stalls, WithinAbs(before / 0.0558, 3.0));
  CHECK_THAT(before, WithinAbs(1e-3 * (20000 + 5.3 * stalls), 0.01 * before));
}

TEST_CASE("a device with the same options and seed gives the same samples", "[device][simulated]") {
  SimulatedOptions o;
  o.jitter = 0.5e-3;
  SimulatedDevice a = started(o), b = started(o);
  o.seed = 2;
  SimulatedDevice c = started(o);
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const double t = a.read().time;
    CHECK(t == b.read().time);
    if (t != c.read().time) ++different;
  }
  CHECK(different > 90);
}

TEST_CASE("simulated devices satisfy the laws", "[device][simulated][laws]") {
  for (SimulatedOptions o : {SimulatedOptions::stylus(), SimulatedOptions::precise_stylus(),
                             SimulatedOptions::game_controller(), SimulatedOptions::parallel_arm()}) {
    for (const SimulatedHand& hand : {SimulatedHand::none(), SimulatedHand::firm()}) {
      o.hand = hand;
      o.delay = 1.5e-3;
      o.jitter = 0.3e-3;
      SimulatedDevice device(o);
      CHECK(testing::describe(testing::device_laws(device)) == "");
    }
  }
}

TEST_CASE("stop and a lost device set the force to zero, with any delay", "[device][simulated][extreme][D6]") {
  SimulatedOptions o = linear();
  o.delay = 2e-3;
  SimulatedDevice device = started(o);
  for (int i = 0; i < 10; ++i) {
    device.read();
    device.write(gated(Vector3(0.0, 0.0, 1.0)));
  }
  CHECK(device.motor_force() == Vector3(0.0, 0.0, 1.0));
  SECTION("stop") {
    device.stop();
  }
  SECTION("unplugged") {
    device.unplug();
    CHECK(!device.read().valid);
  }
  CHECK(device.motor_force() == Vector3::Zero());
  device.read();
  CHECK(device.motor_force() == Vector3::Zero());
}

TEST_CASE("invalid simulated devices are refused", "[device][simulated]") {
  const auto refused = [](auto change) {
    SimulatedOptions o;
    change(o);
    try {
      SimulatedDevice device(o);
    } catch (const SetupError& error) {
      return error.kind() == SetupErrorKind::bad_argument;
    }
    return false;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {-1.0, nan, infinity}) {
    CHECK(refused([=](SimulatedOptions& o) { o.rate = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.mass = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.damping = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.friction = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.encoder_step = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.delay = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.jitter = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.stall = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.stall_interval = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.hand.stiffness = bad; }));
    CHECK(refused([=](SimulatedOptions& o) { o.limits.peak_force = bad; }));
  }
  CHECK(refused([=](SimulatedOptions& o) { o.mass = 0.0; }));
  CHECK(refused([=](SimulatedOptions& o) { o.start[1] = nan; }));
  CHECK(refused([](SimulatedOptions& o) { o.delay = 33e-3; }));
  CHECK(refused([](SimulatedOptions& o) { o.jitter = 1e-3; }));
  CHECK(!refused([](SimulatedOptions& o) { o.delay = 32e-3; }));
}

TEST_CASE("a linear loop is unstable above the stiffness (b + B) / (T/2 + dT) and stable below",
          "[device][simulated][stability]") {
  struct Case {
    double mass, damping, period, ticks;
  };
  for (const Case& c : {Case{0.05, 0.1, 0.2e-3, 0.0},
                        {0.1, 0.5, 1e-3, 0.0},
                        {0.1, 0.5, 1e-3, 1.0},
                        {1.0, 5.0, 1e-3, 2.0},
                        {1.0, 0.5, 3.3e-3, 1.0},
                        {0.3, 1.0, 1e-3, 0.5}}) {
    SimulatedOptions o = linear(c.mass, c.damping);
    o.rate = 1.0 / c.period;
    o.delay = c.ticks * c.period;
    o.limits.peak_force = 1e9;
    const auto is_stable = [&](double stiffness) {
      SimulatedDevice device = started(o);
      VirtualWall wall{.stiffness = stiffness, .one_sided = false};
      device.push(Vector3(0.0, 0.0, 1e-6));
      testing::travel(device, wall, 100.0 * c.mass / c.damping * 0.1);
      const double early = testing::travel(device, wall, 10.0 * c.mass / c.damping);
      testing::travel(device, wall, 100.0 * c.mass / c.damping);
      return testing::travel(device, wall, 10.0 * c.mass / c.damping) < early;
    };
    const double expected = testing::stiffness_limit(c.damping, c.period, o.delay);
    INFO("m " << c.mass << " b " << c.damping << " T " << c.period << " d " << c.ticks);
    CHECK_THAT(testing::largest_that(is_stable, 0.2 * expected, 5.0 * expected, 1e-3), WithinRel(expected, 0.02));
  }
}

TEST_CASE("with friction and encoder steps energy is generated above the stiffness 2 f / step and not below",
          "[device][simulated][stability]") {
  // The worst motion: in each period across the same edge between two encoder steps, inwards just after a sample
  // outside, outwards just after a sample inside. The hand is stiff and critically damped, so it arrives in time.
  for (const auto& [friction, encoder_step] : {std::pair(0.26, 55e-6), {0.04, 30e-6}}) {
    const double step = encoder_step;
    SimulatedOptions o = linear(1e-3, 0.0);
    o.friction = friction;
    o.encoder_step = step;
    o.hand = {.mass = 0.0, .damping = 40.0, .stiffness = 4e5};
    const auto passive = [&](double stiffness) {
      SimulatedDevice device = started(o);
      VirtualWall wall{.stiffness = stiffness};
      double before = 0.0;
      for (int i = 0; i < 80; ++i) {
        if (i == 40) before = device.energy().hand;
        const bool in = i % 2 == 0;
        device.move_hand(Vector3(0.0, 0.0, -(10.5 + (in ? 0.3 : -0.3)) * step - wall.force.force()[2] / 4e5));
        testing::tick(device, wall);
      }
      return device.energy().hand - before >= 0.0;
    };
    const double expected = 2.0 * friction / step;
    CHECK_THAT(testing::largest_that(passive, 0.2 * expected, 5.0 * expected, 1e-3), WithinRel(expected, 0.03));
  }
}
