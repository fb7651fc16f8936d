// The scenes of examples/live without a window: the same forces as a session without its parts, zero when it ends.
#include "core/stage.hpp"

#include <palpate/device/recorder.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "catch.hpp"

#include <mutex>
#include <optional>

#include "live/lock_counter.hpp"

using namespace palpate;

namespace {

live::Tuning quick_tuning(const live::TouchScene& scene) {
  return {.friction = scene.session.contact.friction, .error_bars = false};
}

std::unique_ptr<live::Organ> first_organ(const live::TouchScene& scene) {
  return live::make_organ(scene, scene.compositions.front(), quick_tuning(scene));
}

/// The ticks of all tools of a scene. `drawn`: the picture is computed sixty times a second, as by the window.
std::vector<std::vector<RecordedTick>> play(const live::TouchScene& scene, double seconds, bool drawn) {
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(first_organ(scene), quick_tuning(scene));
  for (std::size_t i = 0; i < stage.tools().size(); ++i) stage.log(i).record(true);
  live::PointerScript script(scene.script);
  const int frames = static_cast<int>(std::lround(50.0 * seconds));
  for (int k = 0; k < frames; ++k) {
    stage.run(0.02, script);
    if (drawn) stage.look();
  }
  stage.stop();
  std::vector<std::vector<RecordedTick>> all;
  for (std::size_t i = 0; i < stage.tools().size(); ++i) {
    CHECK(stage.rendered_force(i).isZero(0.0));
    all.push_back(stage.log(i).recorded());
  }
  return all;
}

/// Replays a recording; before the first read of a tick does the background work that is due.
struct SteppedReplay {
  ReplayDevice replay;
  live::Organ* organ;
  std::vector<Vector3> forces{};
  int reads = 0;
  double next = 0.0;

  ToolState read() noexcept {
    if (organ != nullptr && 1e-3 * reads++ >= next - 1e-9) {
      organ->work();
      next += organ->work_interval();
    }
    return replay.read();
  }
  Status write(const GatedForce& force) noexcept {
    forces.push_back(force.force());
    return replay.write(force);
  }
  DeviceLimits limits() const noexcept { return replay.limits(); }
  void start() noexcept { replay.start(); }
  void stop() noexcept { replay.stop(); }
};

/// Replays a recording, and counts heap calls and locked mutexes from the end of the first read of a tick to the begin
/// of the first write.
class CountingReplay final : public live::AnyDevice {
 public:
  explicit CountingReplay(std::vector<RecordedTick> recording)
      : replay_(std::move(recording), live::MouseDevice(Vector3::Zero(), DeviceClock::simulated).limits()) {}

  ToolState read() noexcept override {
    const ToolState state = replay_.read();
    before_ = testing::AllocationScope();
    locks_before_ = test::locks_of_thread();
    return state;
  }
  Status write(const GatedForce& force) noexcept override {
    if (before_) {
      allocations += before_->allocations();
      locks += test::locks_of_thread() - locks_before_;
      largest = std::max(largest, force.force().norm());
      ++ticks;
    }
    before_.reset();
    return replay_.write(force);
  }
  DeviceLimits limits() const noexcept override { return replay_.limits(); }
  void start() override { replay_.start(); }
  void stop() noexcept override { replay_.stop(); }

  std::uint64_t allocations = 0, locks = 0, ticks = 0;
  double largest = 0.0;

 private:
  ReplayDevice replay_;
  std::optional<testing::AllocationScope> before_;
  std::uint64_t locks_before_ = 0;
};

bool same_bits(const Vector3& a, const Vector3& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

TEST_CASE("every scene renders the same forces with and without the window's parts, and as a plain session", "[live]") {
  for (const std::string& name : live::scene_names()) {
    INFO(name);
    const live::TouchScene scene = live::make_scene(name);
    constexpr double seconds = 3.0;
    const auto drawn = play(scene, seconds, true), plain = play(scene, seconds, false);

    const auto organ = first_organ(scene);
    TissueView view = organ->view();
    const DeviceLimits limits = live::MouseDevice(Vector3::Zero(), DeviceClock::simulated).limits();
    std::vector<SteppedReplay> replays;
    for (const auto& ticks : plain)
      replays.push_back({ReplayDevice(ticks, limits), replays.empty() ? organ.get() : nullptr});
    const ServoOptions options = live::tuned_session(scene, quick_tuning(scene));
    std::optional<HapticSession> session;
    if (replays.size() == 1)
      session.emplace(replays[0], view, scene.tools, options);
    else
      session.emplace(std::tie(replays[0], replays[1]), view, scene.tools, options);
    session->run({.duration = seconds, .paced = false});

    double largest = 0.0;
    for (std::size_t tool = 0; tool < plain.size(); ++tool) {
      REQUIRE(plain[tool].size() == 3000);
      REQUIRE(drawn[tool].size() == plain[tool].size());
      int with_window = 0, with_session = 0;
      for (std::size_t k = 0; k < plain[tool].size(); ++k) {
        with_window += same_bits(drawn[tool][k].force, plain[tool][k].force) ? 0 : 1;
        with_session += same_bits(replays[tool].forces[k], plain[tool][k].force) ? 0 : 1;
        largest = std::max(largest, plain[tool][k].force.norm());
      }
      CHECK(with_window == 0);
      CHECK(with_session == 0);
    }
    CHECK(largest > 0.05);  // the script touches
    CHECK(largest <= DeviceLimits{}.peak_force * (1.0 + 1e-9));
  }
}

TEST_CASE("ticks of every scene allocate nothing and lock nothing", "[live][allocation]") {
  {
    std::mutex any;
    const std::uint64_t before = test::locks_of_thread();
    const std::scoped_lock lock(any);
    if (test::locks_are_counted) CHECK(test::locks_of_thread() == before + 1);
  }
  for (const std::string& name : live::scene_names()) {
    INFO(name);
    const live::TouchScene scene = live::make_scene(name);
    std::vector<std::unique_ptr<live::AnyDevice>> devices;
    std::vector<CountingReplay*> counters;
    for (auto& ticks : play(scene, 3.0, false)) {
      auto device = std::make_unique<CountingReplay>(std::move(ticks));
      counters.push_back(device.get());
      devices.push_back(std::move(device));
    }
    live::Stage stage(scene, live::Clock::simulated, std::move(devices));
    stage.touch(first_organ(scene), quick_tuning(scene));
    live::PointerScript nothing;
    for (int k = 0; k < 30; ++k) stage.run(0.1, nothing);
    double largest = 0.0;
    for (const CountingReplay* c : counters) {
      CHECK(c->ticks == 3000);
      CHECK(c->allocations == 0);
      CHECK(c->locks == 0);
      largest = std::max(largest, c->largest);
    }
    CHECK(largest > 0.05);
    stage.stop();
  }
}

TEST_CASE("ticks of a live session allocate nothing, with the pointer and the log in use", "[live]") {
  const live::TouchScene scene = live::make_scene("palpate");
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(first_organ(scene), quick_tuning(scene));
  stage.handle({.action = live::PointerAction::press, .x = 0.4, .y = 0.45});
  live::PointerScript nothing;
  stage.run(0.2, nothing);
  stage.handle({.action = live::PointerAction::wheel, .amount = 5e-3});
  const std::function<void(double)> no_event = [](double) {};
  const testing::AllocationScope scope;
  stage.loop()->run(0.2, no_event);
  CHECK(scope.allocations() == 0);
  stage.fetch();
  CHECK(stage.log().newest().tick.force.norm() > 0.05);
}

TEST_CASE("a device that is unplugged or closed while it presses renders no force", "[live]") {
  const live::TouchScene scene = live::make_scene("palpate");
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(first_organ(scene), quick_tuning(scene));
  stage.handle({.action = live::PointerAction::press, .x = 0.4, .y = 0.45});
  stage.handle({.action = live::PointerAction::wheel, .amount = 6e-3});
  live::PointerScript nothing;
  stage.run(0.4, nothing);
  CHECK(stage.rendered_force(0).norm() > 0.05);
  stage.handle({.action = live::PointerAction::key, .key = 'U'});
  stage.run(0.01, nothing);
  CHECK(stage.rendered_force(0).isZero(0.0));
  CHECK(stage.log().newest().tick.status.has(StatusFlag::disconnected));
  stage.handle({.action = live::PointerAction::key, .key = 'U'});
  stage.run(0.4, nothing);
  CHECK(stage.rendered_force(0).norm() > 0.05);
  SECTION("closed") {
    stage.stop();
  }
  SECTION("another composition in the middle of a press") {
    stage.touch(live::make_organ(scene, live::Composition::tet4, quick_tuning(scene)), quick_tuning(scene));
    CHECK(stage.rendered_force(0).isZero(0.0));
    stage.run(0.4, nothing);
    CHECK(stage.rendered_force(0).norm() > 0.05);  // the hand still presses: no tissue is lost
    stage.stop();
  }
  CHECK(stage.rendered_force(0).isZero(0.0));
}

TEST_CASE("a refused organ leaves the one before, and a script that is not understood names its line", "[live]") {
  live::TouchScene scene = live::make_scene("beating");
  live::Stage stage(scene, live::Clock::simulated);
  stage.touch(first_organ(scene), quick_tuning(scene));
  live::Tuning impossible = quick_tuning(scene);
  impossible.stiffness = -1.0;
  CHECK_THROWS_AS(live::make_organ(scene, live::Composition::beating, impossible), SetupError);
  CHECK(stage.running());
  try {
    live::PointerScript("0.1 move 0.5 0.5\n0.2 fly 1 1\n");
    FAIL("was not refused");
  } catch (const SetupError& error) {
    CHECK(std::string(error.what()).find("line 2") != std::string::npos);
  }
}

TEST_CASE("a ray through a point of the picture meets the camera's plane there, and the surface in front of it",
          "[live]") {
  live::Camera camera;
  camera.target = {0.01, -0.02, 0.03};
  const Vector3 point = camera.in_plane(0.3, 0.7, camera.target);
  const Eigen::Vector4d clip = camera.projection() * camera.view() * point.homogeneous();
  CHECK(std::abs(clip[0] / clip[3] - (2.0 * 0.3 - 1.0)) < 1e-12);
  CHECK(std::abs(clip[1] / clip[3] - (1.0 - 2.0 * 0.7)) < 1e-12);

  live::DrawnSurface square;  // z = 1, seen from above
  square.positions = {0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto hit = square.hit({{0.25, 0.5, 3.0}, {0.0, 0.0, -1.0}});
  REQUIRE(hit.has_value());
  CHECK((hit->point - Vector3(0.25, 0.5, 1.0)).norm() < 1e-12);
  CHECK((hit->normal - Vector3::UnitZ()).norm() < 1e-12);
  CHECK_FALSE(square.hit({{0.25, 0.5, -3.0}, {0.0, 0.0, 1.0}}).has_value());  // from behind
  CHECK_FALSE(square.hit({{1.25, 0.5, 3.0}, {0.0, 0.0, -1.0}}).has_value());
}
