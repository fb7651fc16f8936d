// Stalls, late ticks and bad input with a tissue that moves by itself: simulated, and in threads.
#include "../../benchmarks/faults/faults.hpp"

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/haptic/background_worker.hpp>

#include <chrono>

#include <thread>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("stalls and bad input: force continuous, energy bounded, counters exact", "[haptic][soft][faults]") {
  const ForceLimits limits = ForceLimits::from(faults::device);
  const EnergyLimits energy = EnergyLimits::from(faults::device);
  const double steady = faults::run({}, 0.01).last_force;
  CHECK(steady > 0.5);
  for (const faults::Fault& fault :
       {faults::Fault{.tissue_stall = 0.2}, faults::Fault{.tissue_stall = 0.7},
        faults::Fault{.tissue_stall = 0.05, .device_stall = 0.01}, faults::Fault{.bad_input = true}}) {
    const faults::Outcome o = faults::run(fault, 0.01);
    INFO("tissue " << fault.tissue_stall << " s, device " << fault.device_stall << " s, bad input " << fault.bad_input);
    CHECK(o.not_finite == 0);
    CHECK(o.peak <= limits.peak_force);
    CHECK(o.step <= limits.slew_rate * faults::tick * (1.0 + 1e-9));
    CHECK(o.raw_step <= 0.6 * steady);  // after bad input the tool restarts in the tissue
    CHECK(o.given <= energy.allowance + energy.refill * faults::duration);
    CHECK((fault.fades() || o.taken >= 0.0));
    CHECK(o.stale == o.stale_due);
    CHECK(o.missed == o.missed_due);
    CHECK(o.disconnected == o.disconnected_due);
    CHECK(o.bad == o.bad_due);
    CHECK((fault.tissue_stall > faults::stale_after) == (o.stale > 0 && fault.device_stall == 0.0));
    CHECK(std::abs(o.last_force - steady) <= 0.05 * steady);
  }
}

namespace {

/// A tissue some of whose steps hang.
struct HangingTissue : TissueAdaptor<MovingTissue> {
  HangingTissue(MovingTissue& hanging, int each, int ms) : TissueAdaptor(hanging), every(each), milliseconds(ms) {}

  int every, milliseconds;
  std::uint64_t steps = 0, hung = 0;

  BackgroundStep background_work() noexcept {
    if (++steps % static_cast<unsigned>(every) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      ++hung;
    }
    return tissue().background_work();
  }
};

}  // namespace

TEST_CASE("a tissue thread that hangs, a device thread that is late, and load in another thread",
          "[haptic][soft][faults]") {
  faults::Pad tissue = faults::make_pad(0.01);
  const ServoOptions options = faults::session_options();
  HapticServo servo(tissue, SphereTool{.radius = faults::sphere}, options);
  HangingTissue hanging(tissue, 5, 60);
  std::atomic<bool> done{false};
  std::thread load([&] {
    volatile double x = 0.0;
    while (!done.load(std::memory_order_relaxed)) x = x + 1.0;
  });
  BackgroundWorker worker(hanging);
  const ForceLimits limits = ForceLimits::from(faults::device);
  StatusCounters counters;
  int ticks = 0, wild = 0, kicks = 0, late = 0;
  double before_time = 0.0, most = 0.0;
  std::uint64_t seen = 0, backwards = 0;
  Vector3 before = Vector3::Zero();
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < 1500; ++k) {
    std::this_thread::sleep_for(std::chrono::microseconds(k % 200 == 199 ? 30'000 : 800));
    ToolState state;
    state.time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    state.position = {0.03, 0.03, faults::pad_size[2] + faults::sphere - std::min(0.006, 0.02 * state.time)};
    const GatedForce out = servo.tick({&state, 1})[0];
    counters.count(out.status);
    if (k > 0) late += state.time - before_time > 1.5 * limits.period;
    const double allowed = limits.slew_rate * std::min(k > 0 ? state.time - before_time : limits.period, limits.period);
    wild += !(out.force().norm() <= limits.peak_force);
    kicks += !((out.force() - before).norm() <= allowed * (1.0 + 1e-9) + 1e-12);
    most = std::max(most, out.force().norm());
    backwards += tissue.updates() < seen;
    seen = tissue.updates();
    before = out.force();
    before_time = state.time;
    ++ticks;
  }
  worker.stop();
  done = true;
  load.join();
  CHECK(wild == 0);
  CHECK(kicks == 0);
  CHECK(backwards == 0);
  CHECK(counters[StatusFlag::deadline_missed] == static_cast<std::uint64_t>(late));
  CHECK(late >= 7);
  CHECK(worker.report().pieces == hanging.steps);
  CHECK(worker.report().pieces == tissue.steps());
  CHECK(seen <= tissue.steps());
  CHECK(seen > 0);
  CHECK(worker.report().late >= hanging.hung);
  CHECK(hanging.hung > 0);
  CHECK(most > 0.0);  // how far the ramp gets depends on the load of the machine
  CHECK(ticks == 1500);
}
