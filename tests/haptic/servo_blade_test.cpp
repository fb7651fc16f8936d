// A blade is a tool as any other: gate, energy, status, snapshot, reset; on springs that record the sweeps.
#include <palpate/device/mock_device.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include <sstream>

#include "contact/analytic_tissue.hpp"
#include "refused.hpp"

#include "catch.hpp"

using namespace palpate;

namespace {

/// The corners of a box on springs, 60 x 60 x 40 mm, its top at z = 0; accepts up to `most` cut requests.
struct SweptTissue : StillTissue {
  explicit SweptTissue(std::size_t most = 1000) : room(most) {
    std::vector<Vector3> x;
    for (int i = 0; i < 8; ++i)
      x.emplace_back((i & 1) != 0 ? 0.03 : -0.03, (i & 2) != 0 ? 0.03 : -0.03, (i & 4) != 0 ? 0.0 : -0.04);
    surface = ContactSurface(std::move(x), {{0, 2, 1},
                                            {1, 2, 3},
                                            {4, 5, 6},
                                            {5, 7, 6},
                                            {0, 1, 4},
                                            {1, 5, 4},
                                            {2, 6, 3},
                                            {3, 6, 7},
                                            {0, 4, 2},
                                            {2, 4, 6},
                                            {1, 3, 5},
                                            {3, 7, 5}});
    sweeps.reserve(1000);
  }
  bool try_cut(const BladeSweep& sweep) noexcept {
    if (sweeps.size() >= room) return false;
    sweeps.push_back(sweep);
    return true;
  }
  const ContactSurface& contact_surface() const noexcept { return surface; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return (i == j ? 1e-3 : 0.0) * Matrix3::Identity(); }
  double compliance_bound(int) const noexcept { return 1e-3; }
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_floor() const noexcept { return 1e-12; }
  const Eigen::Isometry3d& to_world() const noexcept { return pose; }

  ContactSurface surface;
  std::vector<BladeSweep> sweeps;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::size_t room;
};
static_assert(TissueModel<SweptTissue>);

const BladeTool blade{.toughness = 100.0};  // an edge of 10 mm: 1 N when all of it is inside

ToolState at(double z, int tick, double x = 0.0) {
  ToolState s;
  s.position = {x, 0.0, z};
  s.time = 1e-3 * tick;
  return s;
}

/// Straight down, 0.05 mm per tick from 5 mm above.
double height(int tick) {
  return 5e-3 - 5e-5 * tick;
}

}  // namespace

TEST_CASE("a blade's force is toughness times edge length, and its sweeps are contiguous", "[haptic][blade]") {
  SweptTissue tissue;
  const Vector3 origin(0.2, -0.1, 0.3);
  tissue.pose = Eigen::Translation3d(origin) * Eigen::AngleAxisd(0.4, Vector3::UnitZ());
  HapticServo servo(tissue, blade);
  CHECK(servo.tick_view().blade()->area() == 0.0);
  GatedForce f;
  for (int k = 0; k < 400; ++k) {
    ToolState s = at(height(k), k);
    s.position += origin;
    const testing::AllocationScope scope;
    f = servo.tick(s);
    const auto calls = scope.allocations() + scope.frees();
    REQUIRE(calls == 0);
  }
  CHECK(f.status.ok());
  CHECK((f.force() - Vector3(0, 0, 1.0)).norm() < 1e-9);
  CHECK((servo.tick_view().contact_force() - f.force()).norm() < 1e-12);
  CHECK((servo.tick_view().proxy() - origin - Vector3(0, 0, height(399) + 1.0 / 500.0)).norm() <
        1e-9);  // coupled by 500 N/m
  REQUIRE(tissue.sweeps.size() > 10);
  for (std::size_t k = 1; k < tissue.sweeps.size(); ++k) {
    CHECK((tissue.sweeps[k].a0 == tissue.sweeps[k - 1].a1));
    CHECK((tissue.sweeps[k].b0 == tissue.sweeps[k - 1].b1));
    CHECK(tissue.sweeps[k].area() >= 0.01 * blade.cut_spacing * (1.0 - 1e-9));
  }
}

TEST_CASE("the force of a blade that is in tissue in part is toughness times that part", "[haptic][blade]") {
  SweptTissue tissue;  // its side is at y = 30 mm
  for (double outside = -4.9e-3; outside < 5e-3; outside += 3.7e-4) {
    HapticServo servo(tissue, blade);
    for (int k = 0; k < 400; ++k) {
      ToolState s = at(height(k), k);
      s.position[1] = 0.03 + outside;
      servo.tick(s);
    }
    INFO("middle of the edge " << 1e3 * outside << " mm outside");
    CHECK_THAT(servo.tick_view().contact_force()[2], Catch::Matchers::WithinAbs(100.0 * (5e-3 - outside), 2e-3));
  }
}

TEST_CASE("a snapshot contains a blade as a cutting contact and can be printed", "[haptic][blade]") {
  SweptTissue tissue;
  ServoOptions options;
  options.contact.capacity = 4;
  HapticServo servo(tissue, {SphereTool{.radius = 5e-3}, blade}, options);
  for (int k = 0; k < 300; ++k) servo.tick(std::array{at(0.05, k, 0.02), at(height(k), k)});
  const ServoSnapshot& snapshot = servo.read_snapshot();
  REQUIRE(snapshot.contact_count == 1);
  const ToolContact& c = snapshot.tool_contacts()[0];
  CHECK(c.cutting);
  CHECK(c.tool == 1);
  CHECK((c.point == servo.tick_view().proxy(1)));
  CHECK((snapshot.contact_force(1) - servo.tick_view().contact_force(1)).norm() < 1e-12);
  CHECK(snapshot.contact_force(1).z() > 0.9);
  CHECK(snapshot.contact_force(0).norm() == 0.0);
  CHECK(snapshot.vertex_forces().empty());
  CHECK((snapshot.axes[1] - Vector3::UnitY()).norm() < 1e-12);
  std::ostringstream out;
  out << snapshot;
  CHECK_THAT(out.str(), test::contains("1 contacts; tool 0: force (0 0 0) N"));
}

TEST_CASE("a blade's gate: ramp, lost reads, NaN, jumps, stale input, peak force", "[haptic][blade]") {
  SweptTissue tissue;
  BladeTool tough = blade;
  tough.toughness = 1e4;  // 100 N
  ServoOptions options;
  options.devices = {{.peak_force = 2.0, .continuous_force = 2.0}};
  HapticServo servo(tissue, tough, options);
  int tick = 0;
  const auto hold = [&](double z, int ticks) {
    GatedForce f;
    for (int k = 0; k < ticks; ++k) f = servo.tick(at(z, tick++));
    return f;
  };
  CHECK(hold(-2e-3, 1).status.has(StatusFlag::ramping));
  GatedForce f = hold(-9e-3, 60);  // 7 mm in one tick, less than the edge
  CHECK(f.status.has(StatusFlag::saturated));
  CHECK(std::abs(f.force().norm() - 2.0) < 1e-9);
  ToolState lost = at(-9e-3, tick++);
  lost.valid = false;
  f = servo.tick(lost);
  CHECK(f.status.has(StatusFlag::disconnected));
  CHECK(f.force().norm() == 0.0);
  f = hold(-9e-3, 1);
  CHECK(f.status.has(StatusFlag::ramping));
  CHECK(servo.tick_view().contact_force().norm() == 0.0);  // it restarts where it is
  hold(-0.013, 60);
  CHECK(servo.tick_view().contact_force().norm() > 1.0);
  f = servo.tick(at(std::numeric_limits<double>::quiet_NaN(), tick++));
  CHECK(f.status.has(StatusFlag::non_finite_input));
  CHECK(servo.tick_view().contact_force().norm() > 1.0);  // last valid pose kept
  f = hold(-0.03, 1);                                     // farther than the edge is long
  CHECK(f.status.has(StatusFlag::reacquired));
  CHECK(servo.tick_view().contact_force().norm() == 0.0);
  hold(-0.034, 60);
  CHECK(servo.tick_view().contact_force().norm() > 1.0);
  for (int k = 0; k < 60; ++k) f = servo.tick(at(-0.034, tick));  // the stamp stands still
  CHECK(f.status.has(StatusFlag::stale));
  CHECK(f.force().norm() == 0.0);
}

TEST_CASE("a blade whose cut requests are refused sets degraded_model and requests the whole cut later",
          "[haptic][blade]") {
  SweptTissue tissue(2);
  HapticServo servo(tissue, blade);
  int degraded = 0;
  for (int k = 0; k < 300; ++k) degraded += servo.tick(at(height(k), k)).status.has(StatusFlag::degraded_model);
  CHECK(degraded > 100);
  tissue.room = 1000;
  CHECK_FALSE(servo.tick(at(height(300), 300)).status.has(StatusFlag::degraded_model));
  REQUIRE(tissue.sweeps.size() == 3);
  CHECK((tissue.sweeps[2].a0 == tissue.sweeps[1].a1));
  CHECK(tissue.sweeps[2].area() > 5.0 * tissue.sweeps[1].area());
}

TEST_CASE("a blade after reset gives bitwise the same run", "[haptic][blade]") {
  SweptTissue tissue;
  HapticServo servo(tissue, blade, {}, EnergyTank(EnergyLimits::from(DeviceLimits{})));
  const auto play = [&] {
    std::vector<Vector3> forces;
    for (int k = 0; k < 500; ++k) {
      ToolState s = at(4e-3 - 8e-3 * std::sin(0.02 * k), k, 5e-3 * std::sin(0.013 * k));
      s.valid = k % 300 < 290;
      forces.push_back(servo.tick(s).force());
    }
    return forces;
  };
  const auto first = play();
  CHECK(servo.tick_view().energy() != nullptr);
  const std::size_t sweeps = tissue.sweeps.size();
  servo.reset();
  CHECK(servo.tick_view().blade()->area() == 0.0);
  CHECK(servo.read_snapshot().contact_count == 0);
  const auto second = play();
  double most = 0.0;
  std::size_t different = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    most = std::max(most, first[k].norm());
    if (first[k] != second[k]) ++different;
  }
  CHECK(most > 0.5);
  CHECK(different == 0);
  CHECK(tissue.sweeps.size() == 2 * sweeps);
}

TEST_CASE("a tissue that cannot be cut refuses a blade, and a blade a rigid coupling", "[haptic][blade]") {
  test::AnalyticTissue springs(4, 0.04, 1e-3);
  const SetupProblem problem = test::refusal([&] { HapticServo(springs, {SphereTool{}, blade}); });
  CHECK(problem.kind == SetupErrorKind::unsupported);
  CHECK_THAT(problem.what, test::contains("this tissue cannot be cut: "));
  CHECK(problem.ids == std::vector<std::int64_t>{1});
  MockDevice stylus(trajectory::poke());
  CHECK_REFUSED(SetupErrorKind::unsupported, HapticSession(stylus, springs, blade));
  SweptTissue tissue;
  ServoOptions rigid;
  rigid.coupling_stiffness = infinity;
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(tissue, blade, rigid));
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(tissue, BladeTool{.cut_spacing = 0.0}));
  CHECK_NOTHROW(HapticSession(stylus, tissue, blade));
}

TEST_CASE("a session with a blade: coupling and limits are its device's", "[haptic][session][blade]") {
  SweptTissue tissue;
  MockDevice stylus(trajectory::poke({.from = {0, 0, 5e-3}, .to = {0, 0, -0.02}, .approach = 0.5, .hold = 9.0}),
                    {.limits = {.peak_force = 0.6, .continuous_force = 0.6, .stiffness = 300.0}});
  HapticSession session(stylus, tissue, blade);
  const LoopReport report = session.run({.duration = 0.6, .paced = false});
  CHECK(report.peak_force <= 0.6 * (1.0 + 1e-12));
  CHECK(report.status[StatusFlag::saturated] > 0);
  CHECK((session.servo().tick_view().proxy() - Vector3(0, 0, -0.02 + 1.0 / 300.0)).norm() < 1e-6);
  CHECK(std::abs(session.snapshot().contact_force().z() - 1.0) < 1e-3);
}
