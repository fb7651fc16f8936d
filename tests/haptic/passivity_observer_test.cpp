// The passivity observer sums work correctly; the energy tank does not limit passive forces and limits active ones.
#include "contact/analytic_tissue.hpp"

#include <palpate/core/setup_error.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/testing/random.hpp>
#include <palpate/testing/stability.hpp>

#include <cstring>
#include <optional>

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const EnergyLimits limits = EnergyLimits::from(DeviceLimits{});

/// A source of force with a tank for the default device after it.
template <class Source>
struct Tanked : testing::Tanked<Source> {
  explicit Tanked(const Source& made = {}) : testing::Tanked<Source>{.source = made, .tank = EnergyTank(limits)} {}
};

/// Pushes on the way out, not on the way in: each cycle generates one newton times the path.
struct Pump {
  double before = 0.0;
  ForceGate gate = testing::open_gate();
  GatedForce force{};
  Vector3 wanted = Vector3::Zero();
  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
    const ToolState& tool = tools.front();
    const double z = tool.position[2];
    if (z > before) wanted = Vector3(0.0, 0.0, 1.0);
    if (z < before) wanted = Vector3::Zero();
    before = z;
    force = gate.apply(wanted, tool.time, tool.time, true, false);
    return {&force, 1};
  }
};

template <class S>
Vector3 at(S& servo, double z, double time) {
  ToolState state;
  state.position[2] = z;
  state.time = time;
  return servo.tick({&state, 1}).front().force();
}

}  // namespace

TEST_CASE("the observer sums the work of the force that acted between samples", "[haptic][energy]") {
  for (int delay : {0, 1, 5, 32}) {
    testing::Random random(3);
    PassivityObserver observer(delay);
    std::vector<Vector3> x, f;
    for (int i = 0; i < 300; ++i) {
      x.push_back(random.vector<3>(-0.1, 0.1));
      f.push_back(random.vector<3>(-3.0, 3.0));
      observer.moved(x.back(), 1e-3 * i);
      observer.gave(f.back());
    }
    double given = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i)
      if (i >= 1 + static_cast<std::size_t>(delay))
        given += f[i - 1 - static_cast<std::size_t>(delay)].dot(x[i] - x[i - 1]);
    CHECK_THAT(observer.given(), WithinAbs(given, 1e-12));
  }
}

TEST_CASE("a wall at the rated stiffness never empties the tank for any motion", "[haptic][energy]") {
  const auto encoder_step = GENERATE(0.0, 55e-6, 1e-3);
  testing::Random random(8);
  for (double stiffness : {500.0, 100.0, 1.0}) {
    Tanked<testing::VirtualWall> wall({.stiffness = stiffness});
    double z = 0.01, t = 0.0, fastest = 1e-6;
    for (int i = 0; i < 200'000; ++i) {
      if (i % 50 == 0) fastest = std::pow(10.0, random.uniform(-7.0, -2.3));  // 0.1 mm/s to 5 m/s
      z = std::clamp(z + random.uniform(-fastest, fastest), -0.006, 0.006);
      t += random.uniform(0.2e-3, 1e-3);
      at(wall, encoder_step > 0.0 ? encoder_step * std::round(z / encoder_step) : z, t);
    }
    INFO("stiffness " << stiffness);
    CHECK(wall.limited == 0);
    CHECK(wall.lowest >= limits.allowance * (1.0 - 1e-9));
  }
}

TEST_CASE("a wall above the rated stiffness is limited when it generates energy", "[haptic][energy]") {
  testing::Random random(8);
  Tanked<testing::VirtualWall> wall({.stiffness = 1500.0});
  for (int i = 0; i < 5000; ++i) at(wall, random.uniform(-2e-3, -1e-3), 1e-3 * i);  // as if shaken without inertia
  CHECK(wall.limited > 1000);
}

TEST_CASE("slow motion over encoder steps passes bitwise unchanged", "[haptic][energy]") {
  Tanked<testing::VirtualWall> wall({.stiffness = 500.0});
  testing::VirtualWall bare{.stiffness = 500.0};
  testing::Random random(12);
  for (int i = 0; i < 100'000; ++i) {
    const double z = -2e-3 + 1e-3 * std::sin(1e-4 * i) + random.uniform(-30e-6, 30e-6);
    const double shown = 55e-6 * std::round(z / 55e-6);
    if (at(wall, shown, 1e-3 * i) != at(bare, shown, 1e-3 * i)) FAIL("tick " << i);
  }
  CHECK(wall.limited == 0);
}

TEST_CASE("a pump is stopped within the documented energy and returns only as the tank refills", "[haptic][energy]") {
  Tanked<Pump> pump;
  PassivityObserver observer(limits.delay);
  const double path = 20e-6;  // per tick; so slow that the device's own damping takes next to nothing
  double z = 0.0, most = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    z += (i / 50) % 2 == 0 ? path : -path;
    const Vector3 force = at(pump, z, 1e-3 * i);
    observer.moved(Vector3(0.0, 0.0, z), 1e-3 * i);
    observer.gave(force);
    const double credit = limits.damping * path * path / 1e-3 * i;
    most = std::max(most, observer.given() - limits.allowance - limits.refill * 1e-3 * i - credit);
  }
  CHECK(most <= 1.0 * path);
  CHECK(pump.limited > 10'000);
  // Without the tank: 200 cycles of 1 mm and 1 N.
  CHECK(observer.given() < 0.2 * 0.2);
}

TEST_CASE("the force decreases without steps while the tank empties", "[haptic][energy]") {
  EnergyTank tank(limits);
  double before = 1.0;
  Status status;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 f = tank.limit(Vector3(0.0, 0.0, 1.0), Vector3(0.0, 0.0, 2e-6 * i), 1e-3 * i, status);
    CHECK(f[2] <= before + 1e-12);
    CHECK(before - f[2] <= 2e-6 / (0.5 * limits.allowance) + 1e-9);
    tank.gave(f);
    before = f[2];
  }
  CHECK(before < 0.6);
  CHECK(status == Status(StatusFlag::energy_injected));
}

TEST_CASE("energy put in during a contact is discarded once the tool is free", "[haptic][energy]") {
  EnergyTank tank(limits);
  Status status;
  for (int i = 0; i < 100; ++i) {  // 1 N against 10 mm: 10 mJ in
    tank.limit(Vector3(0.0, 0.0, 1.0), Vector3(0.0, 0.0, -1e-4 * i), 1e-3 * i, status);
    tank.gave(Vector3(0.0, 0.0, 1.0));
  }
  CHECK(tank.level() > 9e-3);
  for (int i = 100; i < 103; ++i) {
    tank.limit(Vector3::Zero(), Vector3(0.0, 0.0, -1e-2), 1e-3 * i, status);
    tank.gave(Vector3::Zero());
  }
  CHECK(tank.level() <= limits.allowance);
  CHECK(status.ok());
}

TEST_CASE("simulated: the energy given to the handle is bounded by the tank", "[haptic][energy][stability]") {
  SimulatedOptions o;  // the wall is far too stiff for this device
  o.friction = o.encoder_step = 0.0;
  o.damping = limits.damping;
  for (double stiffness : {3e3, 2e4}) {
    double given[2] = {};
    for (bool tanked : {false, true}) {
      SimulatedDevice device(o);
      device.start();
      device.push(Vector3(0.0, 0.0, -0.5));
      Tanked<testing::VirtualWall> wall({.stiffness = stiffness});
      double over = -infinity;
      for (int i = 0; i < 5000; ++i) {
        if (tanked)
          testing::tick(device, wall);
        else
          testing::tick(device, wall.source);
        const SimulatedEnergy& e = device.energy();
        const double net = e.motors + e.viscous;  // the tank credits less than the dampers dissipate
        given[tanked ? 1 : 0] = std::max(given[tanked ? 1 : 0], net);
        over = std::max(over, net - limits.refill * device.time() - limits.allowance);
      }
      INFO("stiffness " << stiffness);
      if (tanked) CHECK(over <= 1e-3);  // a tick's work
    }
    CHECK(given[0] > 1.5 * given[1]);
  }
}

TEST_CASE("a stall is counted with its actual duration", "[haptic][energy]") {
  EnergyTank slow(limits), fast(limits);
  Status status;
  for (EnergyTank* tank : {&slow, &fast}) {
    tank->limit(Vector3(0.0, 0.0, 1.0), Vector3::Zero(), 0.0, status);
    tank->gave(Vector3(0.0, 0.0, 1.0));
    const double dt = tank == &slow ? 20e-3 : 1e-3;
    tank->limit(Vector3(0.0, 0.0, 1.0), Vector3(0.0, 0.0, 5e-4), dt, status);
  }
  // 0.5 mJ given; b v^2 dt = 0.25 x 2.5e-7 / dt dissipated.
  CHECK_THAT(fast.level(), WithinAbs(limits.allowance - 5e-4 + 6.25e-5 + limits.refill * 1e-3, 1e-12));
  CHECK_THAT(slow.level(), WithinAbs(limits.allowance - 5e-4 + 3.125e-6 + limits.refill * 20e-3, 1e-12));
}

TEST_CASE("special values keep the level within bounds and the gain valid", "[haptic][energy][extreme][D1]") {
  testing::Random random(5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double special[] = {0.0, -0.0, nan, infinity, -infinity, 1e308, -1e308, 5e-324, 1e-3, -1e-3, 1.0};
  const auto any = [&] { return special[static_cast<std::size_t>(random.uniform(0.0, 10.999))]; };
  EnergyTank tank(limits);
  PassivityObserver observer(limits.delay);
  for (int i = 0; i < 300'000; ++i) {
    Status status;
    const Vector3 f(any(), any(), any()), x(any(), any(), any()), given(any(), any(), any());
    const double time = any();
    const Vector3 out = tank.limit(f, x, time, status);
    tank.gave(given);
    observer.moved(x, time);
    observer.gave(given);
    if (!(tank.level() >= -limits.allowance && tank.level() <= limits.capacity)) FAIL("level " << tank.level());
    if (f.allFinite() && !out.allFinite()) FAIL("result " << out.transpose());
    if (!std::isfinite(observer.given())) FAIL("given " << observer.given());
  }
  tank.reset();
  CHECK(tank.level() == limits.allowance);
}

TEST_CASE("invalid energy limits are refused", "[haptic][energy]") {
  const auto refused = [](auto change) {
    EnergyLimits l;
    change(l);
    try {
      EnergyTank tank(l);
    } catch (const SetupError& error) {
      return error.kind() == SetupErrorKind::bad_argument;
    }
    return false;
  };
  for (double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), infinity}) {
    CHECK(refused([=](EnergyLimits& l) { l.allowance = bad; }));
    CHECK(refused([=](EnergyLimits& l) { l.refill = bad; }));
    CHECK(refused([=](EnergyLimits& l) { l.capacity = bad; }));
    CHECK(refused([=](EnergyLimits& l) { l.damping = bad; }));
  }
  CHECK(refused([](EnergyLimits& l) { l.allowance = 0.0; }));
  CHECK(refused([](EnergyLimits& l) { l.capacity = 0.5 * l.allowance; }));
  CHECK(refused([](EnergyLimits& l) { l.delay = 33; }));
  CHECK(!refused([](EnergyLimits& l) { l.delay = 32; }));
}

namespace {

/// An analytic tissue whose compliance is multiplied by `softer`: if that changes during motion, it generates energy.
struct Engine : test::AnalyticTissue {
  using AnalyticTissue::AnalyticTissue;
  double softer = 1.0;
  std::uint64_t revision = 0;
  void become(double s) {
    softer = s;
    ++revision;
  }
  Matrix3 compliance(int i, int j) const noexcept { return softer * AnalyticTissue::compliance(i, j); }
  double compliance_bound(int i) const noexcept { return 40.0 * AnalyticTissue::compliance_bound(i); }
  std::uint64_t compliance_revision() const noexcept { return revision; }
  double compliance_floor() const noexcept { return AnalyticTissue::compliance_floor(); }
};

/// Presses repeatedly 3 mm deep and releases, and returns the energy given.
template <class Energy>
double press(Engine& tissue, const Energy& energy, double soft, std::vector<Vector3>* forces, std::uint64_t* limited) {
  HapticServo servo(tissue, SphereTool{.radius = 5e-3}, {}, energy);
  ToolState state;
  PassivityObserver observer;
  for (int i = 0; i < 4000; ++i) {
    const double phase = 2.0 * 3.14159265358979 * i / 500.0;
    tissue.become(std::sin(phase) > 0.0 ? soft : 1.0);  // soft while pressing in
    state.position = Vector3(0.0, 0.0, 5e-3 - 1.5e-3 + 2e-3 * std::cos(phase));
    state.time = 1e-3 * i;
    const GatedForce& f = servo.tick({&state, 1}).front();
    observer.moved(state.position, state.time);
    observer.gave(f.force());
    if (forces) forces->push_back(f.force());
    if (limited && f.status.has(StatusFlag::energy_injected)) ++*limited;
  }
  return observer.given();
}

}  // namespace

TEST_CASE("a servo with a tank: unchanged forces on a passive tissue, bounded energy on an active one",
          "[haptic][energy]") {
  Engine tissue(20, 0.02, 2e-3);
  std::vector<Vector3> bare, tanked;
  std::uint64_t limited = 0;
  press(tissue, std::nullopt, 1.0, &bare, nullptr);
  const double passive = press(tissue, EnergyTank(limits), 1.0, &tanked, &limited);
  CHECK(passive < limits.allowance);  // generated by sampling, dissipated by the damping of the device
  CHECK(limited == 0);
  REQUIRE(bare.size() == tanked.size());
  double most = 0.0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    most = std::max(most, bare[i].norm());
    if (bare[i] != tanked[i]) FAIL("tick " << i);
  }
  CHECK(most > 0.3);

  const double free = press(tissue, std::nullopt, 40.0, nullptr, nullptr);
  const double bounded = press(tissue, EnergyTank(limits), 40.0, nullptr, &limited);
  INFO("given without a tank " << free << " J, with " << bounded << " J");
  CHECK(limited > 0);
  CHECK(free > 2.0 * bounded);
  CHECK(bounded <= limits.allowance + 4.0 * limits.refill + 1e-3);
}
