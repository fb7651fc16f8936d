// Devices, tools and a tissue in one object: values from the devices, refusals, start, stop and reports.
#include <palpate/device/mock_device.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <chrono>
#include <sstream>
#include <thread>

#include "contact/servo_session.hpp"
#include "refused.hpp"

#include "catch.hpp"

using namespace palpate;
using test::pad_height;
using test::sphere_radius;
using test::whole_pad;

namespace {

static_assert(!std::is_copy_constructible_v<HapticSession> && !std::is_move_constructible_v<HapticSession>);

constexpr SphereTool sphere{.radius = sphere_radius};

LoopOptions simulated(double seconds) {
  LoopOptions options;
  options.duration = seconds;
  options.paced = false;
  return options;
}

/// Down to `depth` within 50 ms, constant after that.
Trajectory press(double x, double depth) {
  const double top = pad_height + sphere_radius;
  return trajectory::poke(
      {.from = {x, 0.015, top + 1e-3}, .to = {x, 0.015, top - depth}, .approach = 0.05, .hold = 1e6});
}
MockDevice<> pressing(double x, double depth, const DeviceLimits& limits = {}, double rate = 1000.0) {
  return MockDevice<>(press(x, depth), {.rate = rate, .limits = limits});
}

/// A device that counts the calls of its functions, and can refuse to start.
struct Counting : MockDevice<> {
  explicit Counting(double x, bool b = false) : MockDevice<>(press(x, 1e-3)), broken(b) {}
  void start() {
    ++starts;
    if (broken) raise(SetupErrorKind::unsupported, "no device");
    MockDevice<>::start();
  }
  void stop() noexcept {
    ++stops;
    MockDevice<>::stop();
  }
  void note(Status) noexcept { ++notes; }
  bool broken;
  int starts = 0, stops = 0, notes = 0;
};

void wait_until(const auto& holds) {
  for (int k = 0; k < 5000 && !holds(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

TEST_CASE("a session takes limits, stiffness and rate from the device", "[haptic][session]") {
  const DeviceLimits limits{.peak_force = 1.7, .continuous_force = 1.1, .stiffness = 800.0};
  MockDevice stylus = pressing(0.015, 4e-3, limits, 500.0);
  HapticSession session(stylus, whole_pad(), sphere);
  CHECK(session.rate() == 500.0);
  const LoopReport report = session.run(simulated(1.0));
  CHECK(report.rate == 500.0);
  CHECK(report.ticks == 500);
  CHECK(stylus.reads() == 500);
  CHECK(report.status[StatusFlag::deadline_missed] == 0);
  CHECK(report.status[StatusFlag::stale] == 0);
  const ForceLimits& gate = session.servo().limits();
  CHECK(gate.peak_force == 1.7);
  CHECK(gate.continuous_force == 1.1);
  CHECK(gate.period == 1.0 / 500.0);
  // The coupling has the stiffness of the device: proxy minus device times stiffness is the force.
  const Vector3 device = press(0.015, 4e-3)(1.0), force = session.servo().tick_view().contact_force();
  CHECK(force.norm() > 0.1);
  CHECK((800.0 * (session.servo().tick_view().proxy() - device) - force).norm() < 1e-6 * force.norm());
}

namespace {

/// A device that gives no present time: a paced loop sets it.
struct WithoutNow : MockDevice<> {
  using MockDevice<>::MockDevice;
  ToolState read() noexcept {
    ToolState state = MockDevice<>::read();
    state.now = std::numeric_limits<double>::quiet_NaN();
    return state;
  }
};

/// Ticks of a recording whose force in a replay, in one run, is another.
int ticks_that_differ(const std::vector<RecordedTick>& ticks, const ServoOptions& options = {}) {
  ReplayDevice replay(ticks);
  Recorder again(replay, ticks.size());
  HapticSession session(again, whole_pad(), sphere, options);
  session.run(simulated(static_cast<double>(ticks.size()) / 1000.0));
  const std::vector<RecordedTick> got = again.ticks();
  REQUIRE(got.size() == ticks.size());
  int differ = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) differ += ticks[i].force != got[i].force;
  return differ;
}

}  // namespace

TEST_CASE("a replay renders the recorded forces: old poses, late ones, lost ones, several starts",
          "[haptic][session][recording]") {
  using Kind = DeviceFault::Kind;
  const std::vector<std::vector<DeviceFault>> cases{
      {},
      {{.kind = Kind::frozen, .first = 300, .count = 50}},
      {{.kind = Kind::stall, .first = 300, .seconds = 0.1}},
      {{.kind = Kind::invalid_read, .first = 300, .count = 5}, {.kind = Kind::nan_position, .first = 400, .count = 5}}};
  for (const auto& faults : cases)
    for (const int starts : {1, 2}) {
      INFO("case " << &faults - cases.data() << ", starts " << starts);
      MockDevice<> stylus(press(0.015, 3e-3), {.faults = faults});
      Recorder recorder(stylus, 2000);
      HapticSession session(recorder, whole_pad(), sphere, {.limit_energy = true});
      for (int k = 0; k < starts; ++k) session.run(simulated(0.5));
      const std::vector<RecordedTick> ticks = recorder.ticks();
      REQUIRE(ticks.size() == static_cast<std::size_t>(500 * starts));
      CHECK(ticks.back().force.norm() > 0.1);  // that of the last tick, not the zero after it
      CHECK(ticks_that_differ(ticks, {.limit_energy = true}) == 0);
    }
}

TEST_CASE("the present time that a paced loop sets is recorded, also of a placed device",
          "[haptic][session][recording]") {
  WithoutNow stylus(press(0.015, 3e-3), MockOptions{.clock = DeviceClock::wall});
  Recorder recorder(stylus, 100'000);
  PlacedDevice placed(recorder, Placement{});
  HapticSession session(placed, whole_pad(), sphere);
  session.run({.duration = 0.2});
  const std::vector<RecordedTick> ticks = recorder.ticks();
  REQUIRE(ticks.size() > 2);
  for (const RecordedTick& tick : ticks) REQUIRE(std::isfinite(tick.state.now));
  CHECK(ticks_that_differ(ticks) == 0);
}

TEST_CASE("devices with different tools in one session: each has its own limits and stiffness", "[haptic][session]") {
  const DeviceLimits weak{.peak_force = 0.1, .continuous_force = 0.08, .stiffness = 300.0};
  const DeviceLimits strong{
      .peak_force = 8.0, .continuous_force = 4.0, .stiffness = 2000.0, .peak_torque = 0.1, .rotational_stiffness = 1.0};
  MockDevice left = pressing(0.009, 5e-3, weak), right = pressing(0.021, 5e-3, strong);
  const CapsuleTool capsule(sphere_radius, 4e-3, Vector3::UnitY());
  HapticSession session(std::tie(left, right), whole_pad(), {sphere, capsule});
  const LoopReport report = session.run(simulated(1.0));
  CHECK(left.reads() == 1000);
  CHECK(right.reads() == 1000);
  REQUIRE(report.devices.size() == 2);
  CHECK(report.devices[0].peak_force == left.peak_force());
  CHECK(report.devices[1].peak_force == right.peak_force());
  CHECK(left.peak_force() <= 0.1 * (1.0 + 1e-12));
  CHECK(right.peak_force() > 0.4);  // more than the limit of the other device
  CHECK(report.devices[0].status[StatusFlag::saturated] > 0);
  CHECK(report.devices[1].status[StatusFlag::saturated] == 0);
  CHECK(report.status[StatusFlag::saturated] == report.devices[0].status[StatusFlag::saturated]);
  CHECK(report.peak_force == right.peak_force());
  const HapticServo& servo = session.servo();
  CHECK(servo.limits(0).peak_torque == 0.0);
  CHECK(servo.limits(1).peak_torque == 0.1);
  const std::array stiffness{300.0, 2000.0}, x{0.009, 0.021};
  for (std::size_t i : {0u, 1u}) {
    const Vector3 stretched = servo.tick_view().proxy(i) - press(x[i], 5e-3)(1.0);
    CHECK((stiffness[i] * stretched - servo.tick_view().contact_force(i)).norm() <
          1e-6 * servo.tick_view().contact_force(i).norm());
  }
}

TEST_CASE("a slower device reduces the rate of a session and the coupling stiffness of a faster one",
          "[haptic][session]") {
  MockDevice fast = pressing(0.009, 3e-3), slow = pressing(0.021, 3e-3, {}, 250.0);
  HapticSession session(std::tie(fast, slow), whole_pad(), {sphere, sphere});
  CHECK(session.rate() == 250.0);
  session.run(simulated(1.0));
  const Vector3 stretched = session.servo().tick_view().proxy(1) - press(0.021, 3e-3)(249.0 / 250.0);
  CHECK((500.0 * stretched - session.servo().tick_view().contact_force(1)).norm() < 1e-6);
  const Vector3 softer = session.servo().tick_view().proxy(0) - press(0.009, 3e-3)(249.0 / 1000.0);
  CHECK((125.0 * softer - session.servo().tick_view().contact_force(0)).norm() < 1e-6);  // a quarter: stable at 250 Hz
}

TEST_CASE("a session refuses what its device does not allow, with value and threshold", "[haptic][session]") {
  MockDevice stylus = pressing(0.015, 1e-3), strong = pressing(0.015, 1e-3, {.peak_force = 8.0, .stiffness = 3000.0});
  const auto refused = [&](const ServoOptions& options, std::int64_t device = 1) {
    const SetupProblem problem = test::refusal([&] {
      HapticSession session(std::tie(strong, stylus), whole_pad(), {sphere, sphere}, options);
    });
    CHECK(problem.kind == SetupErrorKind::bad_argument);
    CHECK(problem.ids == std::vector<std::int64_t>{device});
    CHECK_FALSE(problem.hint.empty());
    return problem;
  };
  const SetupProblem rate = refused({.rate = 1500.0}, 0);
  CHECK(rate.value == 1500.0);
  CHECK(rate.threshold == 1000.0);
  CHECK(refused({.coupling_stiffness = 501.0}).threshold == 500.0);
  for (const double stiff : {infinity, std::numeric_limits<double>::quiet_NaN()})
    CHECK(refused({.coupling_stiffness = stiff}, 0).threshold == 3000.0);
  CHECK(refused({.rate = 500.0, .coupling_stiffness = 260.0}).threshold == 250.0);
  ForceLimits forces = ForceLimits::from(stylus.limits());
  forces.peak_force = 3.4;
  CHECK(refused({.force_limits = forces}).threshold == 3.3);
  forces = ForceLimits::from(stylus.limits());
  forces.continuous_force = 1.0;
  CHECK(refused({.force_limits = forces}, 0).threshold == 0.88);
  forces = ForceLimits::from(stylus.limits());
  forces.peak_torque = 0.1;
  CHECK(refused({.force_limits = forces}, 0).threshold == 0.0);
  const auto session = [&](const ServoOptions& options) {
    HapticSession s(stylus, whole_pad(), sphere, options);
    return s.rate();
  };
  const SetupProblem period =
      test::refusal([&] { session({.rate = 500.0, .force_limits = ForceLimits::from(stylus.limits())}); });
  CHECK(period.value == 1e-3);
  CHECK(period.threshold == 2e-3);
  const SetupProblem devices = test::refusal([&] { session({.devices = {stylus.limits()}}); });
  CHECK(devices.kind == SetupErrorKind::bad_argument);
  CHECK(devices.hint.find("ServoOptions::devices") != std::string::npos);
  CHECK(session({.rate = 500.0, .coupling_stiffness = 250.0}) == 500.0);
  forces = ForceLimits::from(stylus.limits(), 500.0);
  forces.peak_force = 2.0;
  CHECK(session({.rate = 500.0, .force_limits = forces}) == 500.0);
}

TEST_CASE("a session needs one tool per device, and every device once", "[haptic][session]") {
  MockDevice left = pressing(0.01, 1e-3), right = pressing(0.02, 1e-3);
  constexpr auto bad = SetupErrorKind::bad_argument;
  CHECK_REFUSED(bad, HapticSession(left, whole_pad(), {sphere, sphere}));
  CHECK_REFUSED(bad, HapticSession(left, whole_pad(), ToolList{}));
  CHECK_REFUSED(bad, HapticSession(std::tie(left, right), whole_pad(), sphere));
  CHECK_REFUSED(bad, HapticSession(std::tie(left, left), whole_pad(), {sphere, sphere}));
  CHECK_REFUSED(bad, HapticSession(std::tie(), whole_pad(), ToolList{}));
  CHECK_REFUSED(bad, HapticSession(left, whole_pad(), SphereTool{.radius = -1.0}));
}

TEST_CASE("a servo without a session has per-tool limits, too", "[haptic][servo]") {
  ServoOptions options;
  options.devices = {{.peak_force = 1.0}, {.peak_force = 2.0, .rate = 500.0}};
  const HapticServo servo(whole_pad(), {sphere, CapsuleTool(sphere_radius, 2e-3)}, options);
  CHECK(servo.limits(0).peak_force == 1.0);
  CHECK(servo.limits(1).peak_force == 2.0);
  for (std::size_t i : {0u, 1u}) CHECK(servo.limits(i).period == 1.0 / 500.0);
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(whole_pad(), sphere, options));
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(whole_pad(), {sphere, sphere, sphere}, options));
  options.devices[1].stiffness = -1.0;
  const SetupProblem problem = test::refusal([&] { HapticServo(whole_pad(), {sphere, sphere}, options); });
  CHECK(problem.ids == std::vector<std::int64_t>{1});
  options.devices.resize(1);  // for all tools
  const HapticServo equal(whole_pad(), {sphere, sphere}, options);
  for (std::size_t i : {0u, 1u}) CHECK(equal.limits(i).peak_force == 1.0);
  CHECK(equal.tick_view().energy() == nullptr);
}

TEST_CASE("a servo without a session limits the energy of each tool as its device allows", "[haptic][servo]") {
  const DeviceLimits weak{.peak_force = 1.0}, strong{.peak_force = 2.0, .stiffness = 1000.0};
  const HapticServo servo(whole_pad(), {sphere, sphere}, {.limit_energy = true, .devices = {weak, strong}});
  CHECK(servo.tick_view().energy(0)->limits().allowance == EnergyLimits::from(weak).allowance);
  CHECK(servo.tick_view().energy(1)->limits().allowance == EnergyLimits::from(strong).allowance);
  const HapticServo own(whole_pad(), {sphere, sphere}, {.limit_energy = true}, EnergyTank(EnergyLimits{.delay = 3}));
  for (std::size_t i : {0u, 1u}) CHECK(own.tick_view().energy(i)->limits().delay == 3);
}

TEST_CASE("start, read, stop, start again: the second run begins as the first did", "[haptic][session][timing]") {
  Counting stylus(0.015);
  HapticSession session(stylus, whole_pad(), sphere);
  CHECK_FALSE(session.running());
  CHECK(session.stop().ticks == 0);
  CHECK(stylus.stops == 0);
  for (int round = 1; round <= 2; ++round) {
    session.start();
    CHECK(session.running());
    CHECK_REFUSED(SetupErrorKind::bad_argument, session.start());
    CHECK_REFUSED(SetupErrorKind::bad_argument, session.run({.duration = 1.0}));
    wait_until([&] { return session.progress().ticks > 120 && session.snapshot().contact_count > 0; });
    CHECK(session.snapshot().contact_count > 0);
    CHECK(session.snapshot().contact_force().z() > 0.0);
    CHECK(session.progress().fraction == 0.0);
    const LoopReport report = session.stop();
    CHECK_FALSE(session.running());
    CHECK(report.ticks == session.progress().ticks);
    CHECK_FALSE(report.cancelled);  // it had no duration
    CHECK(report.status[StatusFlag::ramping] > 0);
    CHECK(report.status[StatusFlag::reacquired] == 0);
    CHECK(stylus.starts == round);
    CHECK(stylus.stops == round);
    CHECK(stylus.last_force() == Vector3::Zero());
    CHECK(session.snapshot().contact_count > 0);  // of the last tick
  }
  CHECK(static_cast<std::uint64_t>(stylus.notes) == stylus.reads());
}

TEST_CASE("a second run is bitwise equal to the first", "[haptic][session]") {
  /// Returns the same states after every start.
  struct Repeating {
    std::optional<MockDevice<>> inner;
    std::vector<Vector3> forces;
    ToolState read() noexcept { return inner->read(); }
    Status write(const GatedForce& f) noexcept {
      forces.push_back(f.force());
      return inner->write(f);
    }
    DeviceLimits limits() const noexcept { return {}; }
    void start() {
      forces.clear();
      inner.emplace(press(0.015, 2e-3));
      inner->start();
    }
    void stop() noexcept { inner->stop(); }
  } stylus;
  HapticSession session(stylus, whole_pad(), sphere, {.contact = {.friction = 0.3}});
  session.run(simulated(0.2));
  const std::vector<Vector3> first = stylus.forces;
  session.run(simulated(0.2));
  REQUIRE(stylus.forces.size() == first.size());
  CHECK(first[150].norm() > 0.05);
  std::size_t different = 0;
  for (std::size_t k = 0; k < first.size(); ++k)
    if (!test::same(first[k], stylus.forces[k])) ++different;
  CHECK(different == 0);
}

TEST_CASE("a session with a duration ends by itself; devices stop when it is stopped or destroyed",
          "[haptic][session][timing]") {
  Counting stylus(0.015);
  {
    HapticSession session(stylus, whole_pad(), sphere);
    LoopOptions options;
    options.duration = 0.02;
    session.start(options);
    wait_until([&] { return !session.running(); });
    CHECK_FALSE(session.running());
    CHECK(stylus.stops == 0);
    CHECK(stylus.last_force() == Vector3::Zero());
    CHECK_REFUSED(SetupErrorKind::bad_argument, session.start());  // stop() has not been called for its report
    const LoopReport report = session.stop();
    CHECK(report.ticks + report.missed_deadlines == 20);
    CHECK_FALSE(report.cancelled);
    options.duration = 1e6;
    session.start(options);
    CHECK(session.stop().cancelled);
    session.start();
  }  // while it ticks
  CHECK(stylus.starts == 3);
  CHECK(stylus.stops == 3);
}

TEST_CASE("invalid runs are refused and leave nothing running", "[haptic][session]") {
  Counting stylus(0.015);
  HapticSession session(stylus, whole_pad(), sphere);
  constexpr auto bad = SetupErrorKind::bad_argument;
  CHECK_REFUSED(bad, session.run({}));  // it would never end
  for (const double duration : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_REFUSED(bad, session.run(simulated(duration)));
    CHECK_REFUSED(bad, session.start(simulated(duration)));
  }
  LoopOptions called;
  called.progress = [](const LoopProgress&) { return true; };
  CHECK_REFUSED(bad, session.start(called));
  CHECK_FALSE(session.running());
  CHECK(stylus.starts == 0);
  called.progress = [](const LoopProgress&) -> bool { throw std::runtime_error("enough"); };
  CHECK_THROWS_AS(session.run(called), std::runtime_error);
  CHECK_FALSE(session.running());
  CHECK(stylus.starts == 1);
  CHECK(stylus.stops == 1);
  called.progress = [](const LoopProgress&) { return false; };
  CHECK(session.run(called).cancelled);
  CHECK(stylus.stops == 2);
}

TEST_CASE("when the second device does not start, the first one is stopped and nothing runs", "[haptic][session]") {
  Counting left(0.01), right(0.015, true), third(0.02);
  HapticSession session(std::tie(left, right, third), whole_pad(), {sphere, sphere, sphere});
  CHECK_REFUSED(SetupErrorKind::unsupported, session.start());
  CHECK_FALSE(session.running());
  CHECK(left.starts == 1);
  CHECK(left.stops == 1);
  CHECK(right.stops == 1);
  CHECK(third.starts == 0);
  CHECK(third.stops == 0);
  CHECK(left.reads() == 0);
  right.broken = false;  // plugged in: the same session starts
  CHECK(session.run(simulated(0.1)).ticks == 100);
  CHECK(left.stops == 2);
  CHECK(third.stops == 1);
}

TEST_CASE("a stopped session exerts no force on the tissue", "[haptic][session]") {
  struct Listening : test::AnalyticTissue {
    using AnalyticTissue::AnalyticTissue;
    void end_tick(std::span<const VertexForce> forces, std::span<const PointForce>) noexcept {
      pressing = forces.size();
    }
    std::size_t pressing = 0;
  } tissue(10, 0.04, 1e-3);
  MockDevice stylus(trajectory::poke({.from = {0, 0, 6e-3}, .to = {0, 0, 4e-3}, .approach = 0.05, .hold = 1e6}));
  HapticSession session(stylus, tissue, SphereTool{.radius = 5e-3});
  session.run(simulated(0.2));
  CHECK(session.snapshot().vertex_forces().size() > 0);
  CHECK(tissue.pressing == 0);
}

TEST_CASE("simulated hands: different devices come to rest on the tissue", "[haptic][session]") {
  const auto in_hand = [](SimulatedOptions options, double x) {
    options.hand = SimulatedHand::firm();
    options.start = Vector3(x, 0.015, pad_height + sphere_radius);
    return options;
  };
  SimulatedDevice left(in_hand(SimulatedOptions::stylus(), 0.009)),
      right(in_hand(SimulatedOptions::parallel_arm(), 0.021));
  left.push({0.0, 0.0, -0.5});
  right.push({0.0, 0.0, -0.8});
  HapticSession session(std::tie(left, right), whole_pad(), {sphere, sphere}, {.limit_energy = true});
  const LoopReport report = session.run(simulated(2.0));
  CHECK(session.servo().tick_view().energy(0)->limits().allowance == EnergyLimits::from(left.limits()).allowance);
  CHECK(session.servo().tick_view().energy(1)->limits().allowance == EnergyLimits::from(right.limits()).allowance);
  CHECK(report.status[StatusFlag::non_finite_force] == 0);
  CHECK(report.status[StatusFlag::energy_injected] == 0);
  for (const SimulatedDevice* device : {&left, &right}) CHECK(device->velocity().norm() < 5e-3);
  CHECK(report.devices[0].peak_force > 0.05);
  CHECK(report.devices[1].peak_force > 0.05);
}

TEST_CASE("read, tick and write of several devices allocate nothing", "[haptic][session][allocation]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  /// Counts allocations of all threads from its tenth read on.
  struct Watching : MockDevice<> {
    using MockDevice<>::MockDevice;
    ToolState read() noexcept {
      if (reads() == 10) scope.emplace();
      if (reads() == 1500) allocations = scope->allocations() + scope->frees();
      return MockDevice<>::read();
    }
    std::optional<testing::AllocationScope> scope;
    std::uint64_t allocations = 1;
  } left(press(0.009, 2e-3));
  MockDevice right = pressing(0.021, 2e-3);
  HapticSession session(std::tie(left, right), whole_pad(), {sphere, CapsuleTool(sphere_radius, 3e-3)});
  CHECK(session.run(simulated(1.6)).ticks == 1600);
  CHECK(left.allocations == 0);
}

TEST_CASE("snapshots, statuses and reports can be printed; a snapshot converts to vertex forces", "[haptic][session]") {
  MockDevice left = pressing(0.009, 2e-3), right = pressing(0.021, 2e-3);
  HapticSession session(std::tie(left, right), whole_pad(), {sphere, sphere});
  const LoopReport report = session.run(simulated(0.5));
  const ServoSnapshot& snapshot = session.snapshot();
  std::ostringstream out;
  out << snapshot << '\n' << report;
  for (const char* part : {"t = 0.499 s", "contacts; tool 0: force (", "; tool 1: force (", " N, proxy (",
                           "device 0: peak", "device 1: peak", "status: Ramping"})
    CHECK_THAT(out.str(), test::contains(part));
  for (std::size_t i : {0u, 1u})
    CHECK((snapshot.contact_force(i) - session.servo().tick_view().contact_force(i)).norm() < 1e-9);
  const auto sum = [](std::span<const VertexForce> forces) {
    Vector3 all = Vector3::Zero();
    for (const VertexForce& f : forces) all += f.force.in_model_axes();
    return all;
  };
  CHECK((sum(snapshot) + snapshot.contact_force(0) + snapshot.contact_force(1)).norm() < 1e-9);
}
