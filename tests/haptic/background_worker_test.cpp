// Steps in a thread of their own, and tissue that does not keep up.
#include <palpate/element/smoothed.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <chrono>
#include <thread>

#include "catch.hpp"

using namespace palpate;

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
