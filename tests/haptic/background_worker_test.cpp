// Steps in a thread of their own, tissue that does not keep up, and work that throws or that nobody does.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <chrono>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "refused.hpp"

#include "catch.hpp"

using namespace palpate;

namespace {

using Moving = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;

Moving small_block() {
  return Moving(box_tet4({0.06, 0.06, 0.03}, {3, 3, 2}), Scene().fix("z0").touch("z1"), NeoHookean{5e3, 0.45, 1000.0});
}
ToolState above(double time) {
  ToolState state;
  state.position = {0.03, 0.03, 0.05};
  state.time = state.now = time;
  return state;
}

/// Throws in the third piece of work.
template <class Exception>
struct Throwing : TissueAdaptor<Moving> {
  using TissueAdaptor::TissueAdaptor;
  BackgroundStep background_work() {
    if (++pieces == 3) throw Exception();
    return tissue().background_work();
  }
  int pieces = 0;
};
struct NoMessage {};
struct OutOfOrder : std::runtime_error {
  OutOfOrder() : runtime_error("the pump is out of order") {}
};

template <class Exception>
void check_failure(const std::string& message) {
  Moving model = small_block();
  Throwing<Exception> tissue(model);
  HapticServo servo(tissue, SphereTool{.radius = 0.012});
  CHECK_FALSE(servo.tick(above(0.0)).status.has(StatusFlag::stalled_tissue));
  {
    BackgroundWorker worker(tissue);
    for (int k = 0; k < 10000 && !worker.failed(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    REQUIRE(worker.failed());
    worker.stop();
    CHECK(worker.report().failure == message);
    CHECK(worker.report().pieces == 2);
    CHECK_THROWS_AS(worker.rethrow_failure(), Exception);
    CHECK(servo.tick(above(1e-3)).status.has(StatusFlag::stalled_tissue));
  }
  BackgroundWorker again(tissue);  // the fourth piece does not throw
  for (int k = 0; k < 10000 && again.report().pieces == 0; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK_FALSE(servo.tick(above(2e-3)).status.has(StatusFlag::stalled_tissue));
  CHECK_FALSE(again.failed());
  CHECK(again.report().failure.empty());
  CHECK_NOTHROW(again.rethrow_failure());
}

}  // namespace

TEST_CASE("work that throws ends, is flagged in ticks and reported; the process goes on", "[haptic][worker][extreme]") {
  check_failure<OutOfOrder>("the pump is out of order");
  check_failure<std::bad_alloc>(std::bad_alloc().what());
  check_failure<NoMessage>("an exception that is no std::exception");
}

TEST_CASE("what looks like other units is on the console of a session", "[haptic][session][report]") {
  const Mesh<Smoothed<Tet4>> mesh = copy_mesh<Smoothed<Tet4>>(box_tet4({0.06, 0.06, 0.03}, {3, 3, 2}));
  const Scene scene = Scene().fix("z0").touch("z1");
  SetupOptions options;
  const bool refuses = GENERATE(false, true);
  if (refuses) options.admission.units = Admission::refuse;
  MockDevice device([](double) noexcept { return Vector3(0.0, 0.0, 30.0); });
  if (!refuses) {
    Moving soft(mesh, scene, NeoHookean{5.0, 0.45, 1000.0});
    HapticSession session(device, soft, SphereTool{10.0});
    std::ostringstream text;
    text << session.run({.duration = 0.01, .paced = false});
    CHECK_THAT(text.str(), test::contains("note: region 'body' has a Young's modulus of 5 Pa: kPa or MPa?"));
    CHECK_THAT(text.str(), test::contains("note: tool 0 is 10 m large: millimetres?"));
    session.start({.duration = 0.01, .paced = false});
    CHECK(session.stop().notes.size() == 2);
  }
  Moving tissue(mesh, scene, NeoHookean{5e3, 0.45, 1000.0}, options);
  TissueAdaptor<Moving> adaptor(tissue);
  const auto make = [&] { HapticSession(device, adaptor, SphereTool{10.0}); };
  if (refuses)
    CHECK_REFUSED(SetupErrorKind::suspicious_units, make());
  else
    CHECK_NOTHROW(make());
  HapticSession usual(device, adaptor, SphereTool{0.012});
  CHECK(usual.run({.duration = 0.01, .paced = false}).notes.empty());
}

TEST_CASE("tissue that moves is refused to a second servo", "[haptic][refused]") {
  Moving model = small_block();
  {
    HapticServo servo(model, SphereTool{.radius = 0.012});
    TissueAdaptor<Moving> same(model);
    CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(model, SphereTool{.radius = 0.012}));
    CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(same, SphereTool{.radius = 0.012}));
    CHECK(servo.tick(above(0.0)).force().isZero(0.0));
  }
  CHECK_NOTHROW(HapticServo(model, SphereTool{.radius = 0.012}));
  // A servo that is refused for another reason leaves no claim.
  CHECK_REFUSED(SetupErrorKind::bad_argument, HapticServo(model, SphereTool{.radius = -1.0}));
  CHECK_NOTHROW(HapticServo(model, SphereTool{.radius = 0.012}));
}

TEST_CASE("a servo that outlives its tissue does not touch the claim of another", "[haptic][refused]") {
  struct Block {
    Moving model = small_block();
  };
  std::optional<Block> block(std::in_place);
  auto servo = std::make_unique<HapticServo>(block->model, SphereTool{.radius = 0.012});
  block.emplace();  // at the same place
  const HapticServo other(block->model, SphereTool{.radius = 0.012});
  servo.reset();
  CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(block->model, SphereTool{.radius = 0.012}));
}

TEST_CASE("a device that returns is no sign of a stalled tissue", "[haptic][worker][extreme]") {
  Moving model = small_block();
  HapticServo servo(model, SphereTool{.radius = 0.012});
  for (int k = 0; k < 2300; ++k) {
    INFO(k);
    if (k % 16 == 0) model.advance();
    ToolState state = above(5000.0 + 1e-3 * k);
    state.valid = !(k < 3 || (k >= 1000 && k < 2005));
    const Status status = servo.tick(state).status;
    REQUIRE_FALSE(status.has(StatusFlag::stalled_tissue));
    if (state.valid) REQUIRE_FALSE(status.has(StatusFlag::stale));
  }
}

TEST_CASE("tissue whose steps nobody makes is flagged as such, not only as stale", "[haptic][worker][extreme]") {
  Moving model = small_block();
  const bool stepped = GENERATE(false, true);
  HapticServo servo(model, SphereTool{.radius = 0.012});
  for (int k = 0; k < 1000; ++k) {
    INFO(k);
    if (stepped && k % 10 == 0) model.advance();
    const Status status = servo.tick(above(1e-3 * k)).status;
    REQUIRE(status.has(StatusFlag::stalled_tissue) == (!stepped && k >= 500));
    if (stepped) REQUIRE_FALSE(status.has(StatusFlag::stale));
  }
}

TEST_CASE("tissue that is slower than real time is flagged in ticks, with its rate", "[haptic][worker][extreme]") {
  using Model = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;
  // a microsecond of motion per step, which takes far longer
  Model model(box_tet4({0.06, 0.06, 0.03}, {3, 3, 2}), Scene().fix("z0").touch("z1"), NeoHookean{5e3, 0.45, 1000.0}, {},
              {.step = 1e-6});
  HapticServo servo(model, SphereTool{.radius = 0.012});
  ToolState state;
  state.position = {0.03, 0.03, 0.05};
  CHECK(!servo.tick(state).status.has(StatusFlag::slow_tissue));
  BackgroundWorker worker(model);
  bool flagged = false;
  for (int k = 1; k < 10000 && !flagged; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    state.time = 1e-3 * k;
    flagged = servo.tick(state).status.has(StatusFlag::slow_tissue);
  }
  CHECK(flagged);
  const WorkerReport report = worker.report();
  CHECK(report.rate > 0.0);
  CHECK(report.rate < 0.5);
}
