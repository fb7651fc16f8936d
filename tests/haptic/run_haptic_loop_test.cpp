// The haptic loop with a mock device and a servo that is a spring behind a wall.
#include <palpate/device/mock_device.hpp>
#include <palpate/testing/device_laws.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/testing/allocation_counter.hpp>
#include <palpate/testing/random.hpp>
#include <chrono>
#include <sstream>
#include <thread>

#include "contact/analytic_tissue.hpp"
#include "device/press_drag_release.hpp"
#include "refused.hpp"

#include "catch.hpp"

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using palpate::testing::gated;

namespace {

/// A wall at z = 0 that pushes back with 500 N/m, behind a force gate. Restarts when the tool jumps.
class SpringServo {
 public:
  explicit SpringServo(const ForceLimits& limits = {}) : gate_(limits) {}

  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
    const ToolState& s = tools.front();
    const bool finite = s.position.allFinite();
    const bool jumped = !((s.position - position_).norm() < 0.01);
    if (finite) position_ = s.position;
    const Vector3 wanted(0.0, 0.0, 500.0 * std::max(0.0, -position_[2]));
    const Vector3 before = gate_.last_force();
    force_ = gate_.apply(wanted, s.time, s.time, s.valid && finite, jumped);
    if (!finite) force_.status.set(StatusFlag::non_finite_input);
    if (jumped) force_.status.set(StatusFlag::reacquired);
    if (s.valid && finite) largest_change_ = std::max(largest_change_, (force_.force() - before).norm());
    sound_ &= force_.force().allFinite();
    ++ticks;
    return {&force_, 1};
  }

  std::uint64_t ticks = 0;
  double largest_change() const { return largest_change_; }
  bool sound() const { return sound_; }

 private:
  ForceGate gate_;
  GatedForce force_;
  Vector3 position_ = Vector3::Zero();
  double largest_change_ = 0.0;
  bool sound_ = true;
};
static_assert(Servo<SpringServo>);

LoopOptions unpaced(double seconds) {
  LoopOptions options;
  options.duration = seconds;
  options.paced = false;
  return options;
}

/// A wall whose force has a bound of 0.2 N, known from the 1000th tick on.
struct WallWithError {
  SpringServo wall;
  GatedForce force;
  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
    force = wall.tick(tools).front();
    const double length = force.force().norm();
    force.error = {0.1, wall.ticks > 1000 ? 0.2 : infinity, length, {0.15, 0.0, 0.0, 0.05}};
    return {&force, 1};
  }
};

}  // namespace

TEST_CASE("the report of a loop counts the ticks whose error was above the allowed part of the force",
          "[haptic][loop][force_error]") {
  MockDevice stylus(trajectory::poke({.times = 3}));
  Recorder recorder(stylus, 4000);
  WallWithError servo;
  LoopOptions options = unpaced(3.0);  // ends above the wall
  options.force_error = 0.15;
  const LoopReport report = run_haptic_loop(recorder, servo, options);
  std::uint64_t contact = 0, over = 0, unknown = 0;
  double at_largest = 0.0;
  for (const RecordedTick& tick : recorder.ticks()) {
    const double force = tick.force.norm();
    if (!(force > 0.0)) continue;
    const bool known = tick.error_bound < infinity;
    unknown += !known;
    contact += known;
    if (!known) continue;
    over += 0.2 > 0.15 * force;
    if (at_largest == 0.0) at_largest = force;
  }
  REQUIRE(over > 0);
  REQUIRE(over < contact);
  CHECK(unknown > 0);
  CHECK(report.errors.contact == contact);
  CHECK(report.errors.over == over);
  CHECK(report.errors.unknown == unknown);
  CHECK(report.errors.share_over() == static_cast<double>(over) / static_cast<double>(contact));
  CHECK(report.errors.largest.bound == 0.2);
  CHECK(report.errors.largest.force == at_largest);
  CHECK(report.devices.front().errors.over == over);
  std::ostringstream text;
  text << report;
  CHECK_THAT(text.str(), test::contains("bound above 15 % in"));
  CHECK_THAT(text.str(), test::contains("largest 0.2 N"));
  CHECK_THAT(text.str(), test::contains("mesh 0.15 N, linearity 0.05 N"));
  CHECK_THAT(text.str(), test::contains("not measured in"));
  options.force_error = 0.0;
  CHECK_REFUSED(SetupErrorKind::bad_argument, run_haptic_loop(recorder, servo, options));
}

TEST_CASE("10 000 ticks in simulated time", "[haptic][loop]") {
  MockDevice stylus(trajectory::poke({.times = 3}));
  SpringServo servo;
  const LoopReport report = run_haptic_loop(stylus, servo, unpaced(10.0));
  CHECK(report.ticks == 10'000);
  CHECK(servo.ticks == 10'000);
  CHECK(stylus.reads() == 10'000);
  CHECK(report.compute.total() == 10'000);
  CHECK(report.lateness.total() == 0);
  CHECK(report.missed_deadlines == 0);
  CHECK_FALSE(report.cancelled);
  CHECK_THAT(report.peak_force, WithinRel(3.3, 1e-12));  // 10 mm deep: 5 N are clamped
  CHECK(report.status[StatusFlag::saturated] > 1000);
  CHECK(report.status[StatusFlag::deadline_missed] == 0);
  CHECK(report.status[StatusFlag::disconnected] == 0);
  CHECK(stylus.last_force() == Vector3::Zero());
  CHECK(stylus.peak_force() <= 3.3 * (1.0 + 1e-12));
  CHECK(report.clock_cost >= 0.0);
  CHECK(report.clock_cost < 1e-3);
}

TEST_CASE("faults on schedule: finite, limited, counted exactly", "[haptic][loop][extreme][D1][D2][D5][D6]") {
  using Kind = DeviceFault::Kind;
  MockOptions options;
  options.faults = {{.kind = Kind::invalid_read, .first = 1200, .count = 50},
                    {.kind = Kind::nan_position, .first = 1700, .count = 3},
                    {.kind = Kind::infinite_position, .first = 1800, .count = 4},
                    {.kind = Kind::teleport, .first = 1900, .count = 10, .offset = Vector3(0, 0, -1.0)},
                    {.kind = Kind::stall, .first = 2000, .count = 1, .seconds = 0.002},
                    {.kind = Kind::stall, .first = 2100, .count = 1, .seconds = 0.005},
                    {.kind = Kind::stall, .first = 2200, .count = 1, .seconds = 0.020},
                    {.kind = Kind::stall, .first = 2300, .count = 1, .seconds = 0.200},
                    {.kind = Kind::frozen, .first = 3000, .count = 100}};
  MockDevice stylus(trajectory::poke({.approach = 0.5, .hold = 5.0}), options);
  SpringServo servo;
  const LoopReport report = run_haptic_loop(stylus, servo, unpaced(4.0));
  CHECK(servo.sound());
  CHECK(servo.largest_change() <= 1.65 + 1e-12);
  CHECK(report.status[StatusFlag::disconnected] == 57);  // invalid reads, NaN and infinite positions
  CHECK(report.status[StatusFlag::non_finite_input] == 7);
  CHECK(report.status[StatusFlag::reacquired] >= 2);
  CHECK(report.status[StatusFlag::deadline_missed] == 5);  // four stalls and the end of the frozen input
  CHECK(report.status[StatusFlag::stale] >= 97);
  CHECK(report.peak_force <= 3.3 * (1.0 + 1e-12));
}

TEST_CASE("random faults for 200 000 ticks", "[haptic][loop][extreme][D1][D2][D5][D6]") {
  testing::Random random(11);
  MockOptions options;
  for (std::uint64_t i = 0; i < 200; ++i)
    options.faults.push_back({.kind = static_cast<DeviceFault::Kind>(random.bits() % 6),
                              .first = random.bits() % 200'000,
                              .count = random.bits() % 40,
                              .offset = random.vector<3>(-1.0, 1.0),
                              .seconds = random.uniform(0.0, 0.3)});
  MockDevice stylus([](double t) { return Vector3(0.0, 0.01 * std::sin(3.0 * t), 0.01 * std::cos(7.0 * t)); }, options);
  SpringServo servo;
  const LoopReport report = run_haptic_loop(stylus, servo, unpaced(200.0));
  CHECK(report.ticks == 200'000);
  CHECK(servo.sound());
  CHECK(servo.largest_change() <= 1.65 + 1e-12);
  CHECK(report.peak_force <= 3.3 * (1.0 + 1e-12));
}

TEST_CASE("a paced loop keeps its rate", "[haptic][loop][timing]") {
  MockOptions wall;
  wall.clock = DeviceClock::wall;
  MockDevice stylus(trajectory::poke(), wall);
  SpringServo servo;
  LoopOptions options;
  options.duration = 0.3;
  const LoopReport report = run_haptic_loop(stylus, servo, options);
  CHECK(report.ticks + report.missed_deadlines == 300);  // on a busy machine some are missed; all are counted
  CHECK(report.lateness.total() == report.ticks);
  CHECK(report.lateness.percentile(0.5) <= report.lateness.percentile(0.99));
  CHECK(report.elapsed >= 0.298);
  CHECK(report.compute.percentile(0.5) < 1e-3);
}

TEST_CASE("a slow servo misses deadlines and the loop reports them", "[haptic][loop][timing][extreme][D5]") {
  struct Slow {
    SpringServo spring;
    std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
      if (++ticks % 10 == 0) std::this_thread::sleep_for(std::chrono::microseconds(5500));
      return spring.tick(tools);
    }
    int ticks = 0;
  } servo;
  MockDevice stylus(trajectory::poke());
  LoopOptions options;
  options.duration = 0.15;
  const LoopReport report = run_haptic_loop(stylus, servo, options);
  CHECK(report.ticks + report.missed_deadlines == 150);
  CHECK(report.missed_deadlines >= 45);  // five per sleep
}

TEST_CASE("the thread flushes denormals and the calling thread does not", "[haptic][loop]") {
  struct Denormal {
    GatedForce force;
    volatile double product = -1.0;
    std::span<const GatedForce> tick(std::span<const ToolState>) noexcept {
      const volatile double small = 1e-300, smaller = 1e-15;
      product = small * smaller;
      return {&force, 1};
    }
  } servo;
  MockDevice stylus(trajectory::poke());
  run_haptic_loop(stylus, servo, unpaced(0.01));
#if defined(PALPATE_HAS_MXCSR) || defined(__aarch64__)
  CHECK(servo.product == 0.0);
#endif
  const volatile double small = 1e-300, smaller = 1e-15;
  CHECK(small * smaller > 0.0);
}

TEST_CASE("progress is reported from the calling thread at most ten times per second", "[haptic][loop][timing]") {
  MockDevice stylus(trajectory::poke());
  SpringServo servo;
  LoopOptions options;
  options.duration = 0.55;
  std::vector<LoopProgress> seen;
  const auto caller = std::this_thread::get_id();
  bool same_thread = true;
  options.progress = [&](const LoopProgress& p) {
    seen.push_back(p);
    same_thread &= std::this_thread::get_id() == caller;
    return true;
  };
  const LoopReport report = run_haptic_loop(stylus, servo, options);
  CHECK(same_thread);
  CHECK(seen.size() >= 1);
  CHECK(static_cast<double>(seen.size()) <= report.elapsed / 0.1 + 1.0);
  for (std::size_t i = 1; i < seen.size(); ++i) CHECK(seen[i].ticks >= seen[i - 1].ticks);
  for (const LoopProgress& p : seen) CHECK((p.fraction >= 0.0 && p.fraction <= 1.0));
}

TEST_CASE("the progress callback may end the loop by returning false or by throwing; the device is stopped",
          "[haptic][loop]") {
  MockDevice stylus([](double) { return Vector3(0, 0, -0.005); });
  SpringServo servo;
  LoopOptions options;
  options.duration = 1e6;
  options.paced = GENERATE(true, false);
  SECTION("false") {
    options.progress = [](const LoopProgress&) { return false; };
    const LoopReport report = run_haptic_loop(stylus, servo, options);
    CHECK(report.cancelled);
    CHECK(report.ticks > 0);
  }
  SECTION("throws") {
    options.progress = [](const LoopProgress&) -> bool { throw std::runtime_error("enough"); };
    CHECK_THROWS_AS(run_haptic_loop(stylus, servo, options), std::runtime_error);
  }
  CHECK(stylus.last_force() == Vector3::Zero());
  stylus.write(gated(Vector3(1, 0, 0)));
  CHECK(stylus.last_force() == Vector3::Zero());  // stopped
}

TEST_CASE("a device that does not start is stopped and its error passed on", "[haptic][loop]") {
  struct Broken : MockDevice<> {
    Broken() : MockDevice<>(trajectory::poke()) {}
    void start() { raise(SetupErrorKind::unsupported, "no device"); }
    void stop() noexcept { ++stops; }
    int stops = 0;
  } device;
  SpringServo servo;
  CHECK_THROWS_AS(run_haptic_loop(device, servo, unpaced(1.0)), SetupError);
  CHECK(device.stops == 1);
  CHECK(servo.ticks == 0);
}

TEST_CASE("a servo that returns no force renders zero", "[haptic][loop]") {
  struct Empty {
    std::span<const GatedForce> tick(std::span<const ToolState>) noexcept { return {}; }
  } servo;
  MockDevice stylus(trajectory::poke());
  const LoopReport report = run_haptic_loop(stylus, servo, unpaced(0.1));
  CHECK(report.peak_force == 0.0);
  CHECK(stylus.peak_force() == 0.0);
}

TEST_CASE("invalid options are refused before the device starts", "[haptic][loop]") {
  struct Rated : MockDevice<> {
    Rated() : MockDevice<>(trajectory::poke()) {}
    DeviceLimits limits() const noexcept { return {.rate = rate}; }
    double rate = 1000.0;
  } stylus;
  SpringServo servo;
  const double nan_value = std::numeric_limits<double>::quiet_NaN();
  for (double bad : {0.0, -1.0, nan_value, infinity, 1e9}) {
    stylus.rate = bad;
    CHECK_REFUSED(SetupErrorKind::bad_argument, run_haptic_loop(stylus, servo, unpaced(1.0)));
    stylus.rate = 1000.0;
    CHECK_REFUSED(SetupErrorKind::bad_argument, run_haptic_loop(stylus, servo, unpaced(bad)));
  }
  CHECK(stylus.reads() == 0);
}

TEST_CASE("a loop that would never end is refused, and one without a duration runs until the callback ends it",
          "[haptic][loop]") {
  MockDevice stylus(trajectory::poke());
  SpringServo servo;
  CHECK_REFUSED(SetupErrorKind::bad_argument, run_haptic_loop(stylus, servo, {}));
  CHECK(stylus.reads() == 0);
  LoopOptions options;
  options.paced = GENERATE(true, false);
  double fraction = 1.0;
  options.progress = [&](const LoopProgress& p) {
    fraction = p.fraction;
    return false;
  };
  const LoopReport report = run_haptic_loop(stylus, servo, options);
  CHECK(report.cancelled);
  CHECK(report.ticks > 0);
  CHECK(fraction == 0.0);
}

TEST_CASE("a loop runs at the rate of its slowest device", "[haptic][loop]") {
  MockDevice fast(trajectory::poke()), slow(trajectory::poke(), {.rate = 250.0});
  struct Two {
    std::array<GatedForce, 2> forces;
    std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
      wrong += tools.size() != 2;
      return forces;
    }
    int wrong = 0;
  } servo;
  const LoopReport report = run_haptic_loop(std::tie(fast, slow), servo, unpaced(2.0));
  CHECK(report.rate == 250.0);
  CHECK(report.ticks == 500);
  CHECK(fast.reads() == 500);
  CHECK(slow.reads() == 500);
  CHECK(servo.wrong == 0);
  CHECK(report.devices.size() == 2);
}

TEST_CASE("real-time privileges are reported as granted or refused with a reason", "[haptic][loop][timing]") {
  MockDevice stylus(trajectory::poke());
  SpringServo servo;
  LoopOptions options;
  options.duration = 0.02;
  options.real_time = true;
  options.cpu = 100'000;  // no such processor
  const RealtimeGrant grant = run_haptic_loop(stylus, servo, options).real_time;
  CHECK(grant.requested);
  CHECK(grant.cpu == -1);
  CHECK_FALSE(grant.refusals.empty());
  options.paced = false;
  options.cpu = -1;
  CHECK_FALSE(run_haptic_loop(stylus, servo, options).real_time.requested);
}

TEST_CASE("the report prints as a table and leaves the stream as it was", "[haptic][loop]") {
  MockDevice stylus(trajectory::poke());
  SpringServo servo;
  std::ostringstream out;
  out << run_haptic_loop(stylus, servo, unpaced(1.0)) << 0.1;
  const std::string text = out.str();
  for (const char* part :
       {"1000 ticks", "not paced", "p50", "p99.9", "tick compute", "peak force", "Ramping", "not requested"})
    CHECK_THAT(text, test::contains(part));
  CHECK(text.ends_with("\n0.1"));
}

TEST_CASE("duration histogram: percentiles within a bin, maximum exact", "[haptic][loop]") {
  DurationHistogram h;
  CHECK(h.percentile(0.5) == 0.0);
  for (int i = 1; i <= 100'000; ++i) h.record(i * 1e-6);
  CHECK(h.total() == 100'000);
  CHECK_THAT(h.percentile(0.5), WithinRel(0.05, 0.02));
  CHECK_THAT(h.percentile(0.99), WithinRel(0.099, 0.02));
  CHECK_THAT(h.percentile(0.999), WithinRel(0.0999, 0.02));
  CHECK(h.percentile(0.5) >= 0.05);
  CHECK(h.percentile(1.0) == 100'000 * 1e-6);
  CHECK(h.max() == 100'000 * 1e-6);
  for (int bin = 0; bin + 1 < DurationHistogram::bins; ++bin) {
    if (!(h.low(bin) < h.low(bin + 1)) || (bin >= 64 && h.low(bin + 1) > h.low(bin) * 1.0157)) FAIL("bin " << bin);
  }
  for (double odd : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), infinity, 1e300, 1e-12}) h.record(odd);
  CHECK(h.total() == 100'006);
  CHECK(h.count(0) == 4);
  CHECK(h.count(DurationHistogram::bins - 1) == 2);
  std::uint64_t sum = 0;
  for (int bin = 0; bin < DurationHistogram::bins; ++bin) sum += h.count(bin);
  CHECK(sum == h.total());
}

TEST_CASE("every duration is counted in the bin that contains it", "[haptic][loop]") {
  for (double seconds = 1.5e-9; seconds < 1e3; seconds *= 1.37) {
    DurationHistogram h;
    h.record(seconds);
    int bin = 0;
    while (h.count(bin) == 0) ++bin;
    INFO(seconds);
    CHECK(h.low(bin) <= seconds * (1.0 + 1e-12));
    CHECK(seconds <= h.low(bin + 1));
  }
}

TEST_CASE("the allocation counter counts malloc, new, realloc and Eigen", "[haptic][allocation]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  const testing::AllocationScope scope;
  double* volatile number_on_heap = new double(1.0);
  CHECK(scope.allocations() >= 1);
  delete number_on_heap;
  CHECK(scope.frees() >= 1);
  const auto count = [](auto&& act) {
    const testing::AllocationScope inner;
    act();
    return inner.allocations();
  };
  VectorX x = VectorX::Ones(100), y(100);
  const MatrixX A = MatrixX::Ones(100, 100);
  CHECK(count([&] { y = A * x; }) >= 1);
  CHECK(count([&] { y.noalias() = A * x; }) == 0);
  void* volatile memory = nullptr;
  CHECK(count([&] { memory = std::calloc(3, 5); }) == 1);
  CHECK(count([&] { memory = std::realloc(memory, 500); }) == 1);
  std::free(memory);
  CHECK(count([&] { memory = std::aligned_alloc(64, 128); }) == 1);
  CHECK(reinterpret_cast<std::uintptr_t>(memory) % 64 == 0);
  std::free(memory);
}

TEST_CASE("read, tick, gate, write allocate nothing", "[haptic][allocation]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  MockOptions options;
  options.faults = {{.first = 100, .count = 10}, {.kind = DeviceFault::Kind::nan_position, .first = 200}};
  MockDevice stylus(test::press_drag_release(), options);
  Recorder recorder(stylus, 1000);
  SpringServo servo;
  recorder.start();
  const testing::AllocationScope scope;
  for (int i = 0; i < 5000; ++i) {
    const ToolState state = recorder.read();
    const GatedForce force = servo.tick(std::span<const ToolState>(&state, 1)).front();
    recorder.write(force);
  }
  const std::uint64_t allocations = scope.allocations(), frees = scope.frees();
  CHECK(allocations == 0);
  CHECK(frees == 0);
}

TEST_CASE("the loop allocates nothing between its first and its last tick", "[haptic][allocation]") {
  if (!testing::allocations_are_counted()) {
    WARN("allocations are not counted in this build");
    return;
  }
  /// Counts allocations in the haptic thread, from tick to tick.
  struct Counting {
    SpringServo spring;
    testing::AllocationScope scope;
    std::uint64_t calls = 1;
    std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
      if (spring.ticks == 0) scope = testing::AllocationScope();
      const auto forces = spring.tick(tools);
      calls = scope.allocations() + scope.frees();
      return forces;
    }
  } servo;
  MockDevice stylus(trajectory::poke());
  Recorder recorder(stylus, 100);
  LoopOptions options = unpaced(2.0);
  SECTION("unpaced") {}
  SECTION("paced") {
    options.paced = true;
    options.duration = 0.1;
  }
  run_haptic_loop(recorder, servo, options);
  CHECK(servo.calls == 0);
}

TEST_CASE("a loop whose punctual ticks would be late for the gate of the servo is refused", "[haptic][loop][refused]") {
  test::AnalyticTissue tissue(4, 0.2, 1e-3);
  HapticServo servo(tissue, SphereTool{.radius = 5e-3});  // 1000 Hz
  for (const double rate : {100.0, 1000.0 / 3.0, 500.0, 666.0, 2000.0 / 3.0}) {
    INFO("rate " << rate);
    MockOptions slow;
    slow.rate = rate;
    MockDevice stylus(trajectory::poke(), slow);
    const SetupProblem problem = test::refusal([&] { run_haptic_loop(stylus, servo, unpaced(0.1)); });
    CHECK(problem.kind == SetupErrorKind::bad_argument);
    CHECK(problem.value == rate);
    CHECK_THAT(problem.threshold, WithinRel(1000.0 / 1.5, 1e-12));
    CHECK(problem.hint.find("ServoOptions::rate") != std::string::npos);
    CHECK(stylus.reads() == 0);
  }
}

TEST_CASE("a loop that is little slower than the servo, or faster, or of the same low rate, renders the full force",
          "[haptic][loop]") {
  const auto run = [](double loop_rate, double servo_rate) {
    test::AnalyticTissue tissue(4, 0.2, 1e-3);
    ServoOptions options;
    options.rate = servo_rate;
    options.coupling_stiffness = 400.0;
    HapticServo servo(tissue, SphereTool{.radius = 5e-3}, options);
    MockOptions device;
    device.rate = loop_rate;
    MockDevice stylus([](double t) { return Vector3(0.0, 0.0, 6e-3 - 3e-3 * std::min(1.0, t / 0.5)); }, device);
    const LoopReport report = run_haptic_loop(stylus, servo, unpaced(1.0));
    INFO("loop " << loop_rate << ", servo " << servo_rate);
    CHECK(report.status[StatusFlag::deadline_missed] == 0);
    CHECK(report.status[StatusFlag::stale] == 0);
    CHECK_THAT(report.peak_force, WithinRel(2e-3 / (1.0 / 400.0 + 1e-3), 1e-3));
  };
  run(667.0, 1000.0);
  run(1000.0, 1000.0);
  run(3000.0, 1000.0);
  run(1000.0, 300.0);
  run(333.0, 333.0);
}
