// Definitions of run_haptic_loop.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/run_haptic_loop.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double measured_clock_cost() noexcept {
  DurationHistogram cost;
  for (int i = 0; i < 1001; ++i) {
    const std::int64_t start = platform::compute_ns();
    cost.record(1e-9 * static_cast<double>(platform::compute_ns() - start));
  }
  return cost.percentile(0.5);
}

/// What the two threads share while the loop runs.
struct LoopShared {
  std::atomic<bool> cancel{false};
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<double> force{0.0};
  std::atomic<double> elapsed{0.0};
  std::mutex mutex;
  std::condition_variable changed;
  bool finished = false;  // guarded by mutex
};

/// The body of the haptic thread.
class LoopBody {
 public:
  LoopBody(const LoopDevice& device, const LoopServo& servo, const LoopOptions& options, LoopShared& shared,
           LoopReport& report)
      : device_(device), servo_(servo), options_(options), shared_(shared), report_(report) {}

  void run() {
    report_.real_time = request_realtime(options_);
    report_.clock_cost = measured_clock_cost();
    {
      const FlushDenormals flush;
      const std::int64_t start = platform::wall_ns();
      if (options_.paced)
        run_paced(start);
      else
        run_unpaced();
      device_.write(device_.device, GatedForce{});  // stop() comes when the other thread gets to it
      report_.elapsed = 1e-9 * static_cast<double>(platform::wall_ns() - start);
    }
    const std::lock_guard lock(shared_.mutex);
    shared_.finished = true;
    shared_.changed.notify_one();
  }

 private:
  std::int64_t periods() const noexcept {
    return std::max<std::int64_t>(1, std::llround(options_.rate * options_.duration));
  }
  bool cancelled() const noexcept { return shared_.cancel.load(std::memory_order_relaxed); }

  void run_unpaced() noexcept {
    const std::int64_t end = periods();
    for (std::int64_t k = 0; k < end && !cancelled(); ++k) tick(static_cast<double>(k) / options_.rate);
  }

  /// Deadlines are absolute, so errors of sleeping do not add up. After a late tick the missed periods are left out:
  /// catching up would send a burst of ticks with hardly any time between them.
  void run_paced(std::int64_t start) noexcept {
    const double period = 1e9 / options_.rate;
    const std::int64_t end = periods();
    for (std::int64_t k = 0; k < end && !cancelled();) {
      const std::int64_t deadline = start + std::llround(period * static_cast<double>(k));
      platform::sleep_until_ns(deadline);
      report_.lateness.record(1e-9 * static_cast<double>(platform::wall_ns() - deadline));
      tick(static_cast<double>(k) / options_.rate);
      const auto passed = static_cast<std::int64_t>(static_cast<double>(platform::wall_ns() - start) / period);
      const std::int64_t next = std::clamp(passed + 1, k + 1, end);
      report_.missed_deadlines += static_cast<std::uint64_t>(next - k - 1);
      k = next;
    }
  }

  void tick(double elapsed) noexcept {
    const ToolState state = device_.read(device_.device);
    const std::int64_t before = platform::compute_ns();
    const std::span<const GatedForce> forces = servo_.tick(servo_.servo, std::span<const ToolState>(&state, 1));
    report_.compute.record(1e-9 * static_cast<double>(platform::compute_ns() - before));
    const GatedForce force = forces.empty() ? GatedForce{} : forces.front();
    if (device_.note != nullptr) device_.note(device_.device, force.status);
    const Status rendered = device_.write(device_.device, force);

    report_.status.count(force.status | rendered);
    const double length = force.force().norm();
    if (length > report_.peak_force) report_.peak_force = length;
    shared_.ticks.store(++report_.ticks, std::memory_order_relaxed);
    shared_.force.store(length, std::memory_order_relaxed);
    shared_.elapsed.store(elapsed, std::memory_order_relaxed);
  }

  const LoopDevice& device_;
  const LoopServo& servo_;
  const LoopOptions& options_;
  LoopShared& shared_;
  LoopReport& report_;
};

inline void require_sane_loop(const LoopOptions& o) {
  if (!(o.rate >= 0.1 && o.rate <= 1e5))
    raise(SetupErrorKind::bad_argument, "a loop rate of " + number(o.rate) + " Hz", "Give 0.1 to 1e5; 1000 is usual");
  if (!(o.duration > 0.0 && o.duration <= 1e8))
    raise(SetupErrorKind::bad_argument, "a loop duration of " + number(o.duration) + " s", "Give seconds, up to 1e8");
}

/// Calls the progress callback until the loop is over.
inline void watch_loop(const LoopOptions& options, LoopShared& shared) {
  std::unique_lock lock(shared.mutex);
  const auto finished = [&] { return shared.finished; };
  while (!shared.changed.wait_for(lock, std::chrono::milliseconds(100), finished)) {
    if (!options.progress || shared.cancel) continue;
    lock.unlock();
    LoopProgress p;
    p.ticks = shared.ticks.load(std::memory_order_relaxed);
    p.force = shared.force.load(std::memory_order_relaxed);
    p.elapsed = shared.elapsed.load(std::memory_order_relaxed);
    p.fraction = p.elapsed / options.duration;
    if (!options.progress(p)) shared.cancel = true;
    lock.lock();
  }
}

PALPATE_INLINE LoopReport run_loop(const LoopDevice& device, const LoopServo& servo, const LoopOptions& options) {
  require_sane_loop(options);
  LoopReport report;
  report.rate = options.rate;
  report.paced = options.paced;
  struct Stop {
    const LoopDevice& device;
    ~Stop() { device.stop(device.device); }
  } const stop{device};
  device.start(device.device);

  LoopShared shared;
  LoopBody body(device, servo, options, shared, report);
  {
    struct Join {
      std::thread thread;
      std::atomic<bool>& cancel;
      ~Join() {
        cancel = true;  // no effect on a loop that is over; ends it when the callback threw
        thread.join();
      }
    };
    const Join join{std::thread([&] { body.run(); }), shared.cancel};
    watch_loop(options, shared);
    report.cancelled = shared.cancel;
  }
  return report;
}

}}}  // namespace palpate::detail
