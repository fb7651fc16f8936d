// Definitions of haptic_loop.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/detail/stamp_clock.hpp>
#include <palpate/haptic/haptic_loop.hpp>

#include <algorithm>
#include <array>
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

PALPATE_INLINE double rate_of(const std::vector<LoopDevice>& devices) noexcept {
  double slowest = infinity;
  for (const LoopDevice& d : devices) slowest = std::min(slowest, d.limits(d.device).rate);
  return slowest;
}

/// Devices of which the first few are started; the destructor stops them at the latest.
class StartedDevices {
 public:
  explicit StartedDevices(std::vector<LoopDevice> devices) noexcept : devices_(std::move(devices)) {}
  ~StartedDevices() { stop(); }
  StartedDevices(const StartedDevices&) = delete;
  StartedDevices& operator=(const StartedDevices&) = delete;

  void start() {
    struct StopUnlessDone {
      StartedDevices* devices;
      ~StopUnlessDone() {
        if (devices != nullptr) devices->stop();
      }
    } guard{this};
    for (const LoopDevice& d : devices_) {
      ++started_;  // one that throws in start is stopped, too
      d.start(d.device);
    }
    guard.devices = nullptr;
  }
  void stop() noexcept {
    for (; started_ > 0; --started_) devices_[started_ - 1].stop(devices_[started_ - 1].device);
  }
  const std::vector<LoopDevice>& all() const noexcept { return devices_; }

 private:
  std::vector<LoopDevice> devices_;
  std::size_t started_ = 0;
};

/// Devices, shared state of the threads, and the body of the haptic thread.
struct HapticLoop::State {
  State(std::vector<LoopDevice> list, const LoopServo& s, double r)
      : devices(std::move(list)), servo(s), rate(r), states(devices.all().size()), clocks(states.size()) {}

  void run();
  void run_unpaced() noexcept;
  void run_paced(std::int64_t start) noexcept;
  void tick(double seconds) noexcept;
  void set_now() noexcept;
  bool is_restarted() const noexcept;
  void silence() noexcept;
  std::int64_t periods() const noexcept;
  bool cancelled() const noexcept { return cancel.load(std::memory_order_relaxed); }
  LoopReport fresh_report() const;
  void end_thread() noexcept;

  StartedDevices devices;
  const LoopServo servo;
  const double rate;
  std::vector<ToolState> states;
  std::vector<StampClock> clocks;
  LoopOptions options;
  LoopReport report;
  bool started = false;
  std::thread thread;

  std::atomic<bool> running{false}, cancel{false};
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<double> force{0.0}, elapsed{0.0}, duration{infinity};
  std::mutex mutex;
  std::condition_variable changed;
};

PALPATE_INLINE void HapticLoop::State::run() {
  report.real_time = request_realtime(options);
  report.clock_cost = measured_clock_cost();
  {
    const FlushDenormals flush;
    const std::int64_t start = platform::wall_ns();
    if (options.paced)
      run_paced(start);
    else
      run_unpaced();
    silence();  // the other thread may call stop() much later
    report.elapsed = 1e-9 * static_cast<double>(platform::wall_ns() - start);
    for (const DeviceReport& own : report.devices) report.errors.count(own.errors);
  }
  const std::lock_guard lock(mutex);
  running.store(false, std::memory_order_release);
  changed.notify_one();
}

PALPATE_INLINE std::int64_t HapticLoop::State::periods() const noexcept {
  if (!std::isfinite(options.duration)) return std::numeric_limits<std::int64_t>::max();
  return std::max<std::int64_t>(1, std::llround(rate * options.duration));
}

PALPATE_INLINE void HapticLoop::State::run_unpaced() noexcept {
  const std::int64_t end = periods();
  for (std::int64_t k = 0; k < end && !cancelled(); ++k) tick(static_cast<double>(k) / rate);
}

/// Deadlines are absolute, so errors of sleeping do not accumulate. After a late tick the missed periods are skipped:
/// catching up would cause a burst of ticks with hardly any time between them.
PALPATE_INLINE void HapticLoop::State::run_paced(std::int64_t start) noexcept {
  const double period = 1e9 / rate;
  const std::int64_t end = periods();
  for (std::int64_t k = 0; k < end && !cancelled();) {
    const std::int64_t deadline = start + std::llround(period * static_cast<double>(k));
    platform::sleep_until_ns(deadline);
    report.lateness.record(1e-9 * static_cast<double>(platform::wall_ns() - deadline));
    tick(static_cast<double>(k) / rate);
    const auto passed = static_cast<std::int64_t>(static_cast<double>(platform::wall_ns() - start) / period);
    const std::int64_t next = std::clamp(passed + 1, k + 1, end);
    report.missed_deadlines += static_cast<std::uint64_t>(next - k - 1);
    k = next;
  }
}

PALPATE_INLINE void HapticLoop::State::tick(double seconds) noexcept {
  const std::vector<LoopDevice>& all = devices.all();
  for (std::size_t i = 0; i < all.size(); ++i) states[i] = all[i].read(all[i].device);
  if (options.paced) set_now();
  if (servo.reset != nullptr && is_restarted()) servo.reset(servo.servo);
  const std::int64_t before = platform::compute_ns();
  const std::span<const GatedForce> forces = servo.tick(servo.servo, states);
  report.compute.record(1e-9 * static_cast<double>(platform::compute_ns() - before));

  Status any;
  double longest = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const GatedForce given = i < forces.size() ? forces[i] : GatedForce{};
    if (all[i].note != nullptr) all[i].note(all[i].device, given.status, states[i].now);
    const Status status = given.status | all[i].write(all[i].device, given);
    const double length = given.force().norm();
    DeviceReport& own = report.devices[i];
    own.status.count(status);
    own.errors.count(given.error);
    own.peak_force = std::max(own.peak_force, length);
    longest = std::max(longest, length);
    any |= status;
  }
  report.status.count(any);
  report.peak_force = std::max(report.peak_force, longest);
  ticks.store(++report.ticks, std::memory_order_relaxed);
  force.store(longest, std::memory_order_relaxed);
  elapsed.store(seconds, std::memory_order_relaxed);
}

/// Sets the present time in states of devices that do not give it.
PALPATE_INLINE void HapticLoop::State::set_now() noexcept {
  const double steady = 1e-9 * static_cast<double>(platform::wall_ns());
  for (std::size_t i = 0; i < states.size(); ++i)
    if (!std::isfinite(states[i].now)) states[i].now = clocks[i].now(states[i].time, steady);
}

/// Whether a replayed device has come to a start of the recorded one.
PALPATE_INLINE bool HapticLoop::State::is_restarted() const noexcept {
  return std::any_of(devices.all().begin(), devices.all().end(),
                     [](const LoopDevice& d) { return d.restarts != nullptr && d.restarts(d.device); });
}

PALPATE_INLINE void HapticLoop::State::silence() noexcept {
  for (const LoopDevice& d : devices.all()) d.write(d.device, GatedForce{});
}

PALPATE_INLINE LoopReport HapticLoop::State::fresh_report() const {
  LoopReport fresh;
  fresh.rate = rate;
  fresh.paced = options.paced;
  fresh.devices.resize(devices.all().size());
  fresh.errors.allowed = options.force_error;
  for (DeviceReport& own : fresh.devices) own.errors.allowed = options.force_error;
  return fresh;
}

PALPATE_INLINE void HapticLoop::State::end_thread() noexcept {
  cancel = true;  // no effect on a loop that has ended
  if (thread.joinable()) thread.join();
  devices.stop();
  started = false;
}

/// Refuses a loop of which every tick would be late for the servo's gate: it would report missed deadlines all the
/// time and, beyond stale_after, render no force.
inline void require_punctual(double rate, const LoopServo& servo) {
  if (rate > servo.slowest_rate * (1.0 + 1e-9)) return;
  SetupProblem slow;
  slow.what = "a haptic loop of " + number(rate) + " Hz is too slow for the servo: its force gate takes ticks of " +
              number(servo.slowest_rate) + " Hz or less as missed";
  slow.hint =
      "Give ServoOptions::rate (or ForceLimits::from) the rate of the loop, that in the slowest device's limits()";
  slow.value = rate;
  slow.threshold = servo.slowest_rate;
  raise(std::move(slow));
}

PALPATE_INLINE HapticLoop::HapticLoop(std::vector<LoopDevice> devices, const LoopServo& servo, double rate) {
  if (devices.empty()) raise(SetupErrorKind::bad_argument, "a haptic loop has no device");
  for (std::size_t i = 0; i < devices.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (devices[i].device != devices[j].device) continue;
      SetupProblem twice;
      twice.what = "a device is given twice";
      twice.set_ids(std::array{static_cast<std::int64_t>(j), static_cast<std::int64_t>(i)});
      raise(std::move(twice));
    }
  if (!(rate >= 0.1 && rate <= 1e5))
    raise(SetupErrorKind::bad_argument, "the rate of a haptic loop is " + number(rate) + " Hz",
          "It is the rate in the slowest device's limits(); it must be 0.1 to 1e5, 1000 is typical");
  require_punctual(rate, servo);
  state_ = std::make_unique<State>(std::move(devices), servo, rate);
}

PALPATE_INLINE HapticLoop::~HapticLoop() {
  state_->end_thread();
}

PALPATE_INLINE void HapticLoop::require_startable(const LoopOptions& options) const {
  if (!(options.duration > 0.0 && (options.duration <= 1e8 || options.duration == infinity)))
    raise(SetupErrorKind::bad_argument, "the duration of a haptic loop is " + number(options.duration) + " s",
          "Give a positive number of seconds, up to 1e8, or none");
  if (!(options.force_error > 0.0))
    raise(SetupErrorKind::bad_argument, "the allowed error of the force is " + number(options.force_error),
          "Give a part of the force, 0.1 is typical");
  if (state_->started)
    raise(SetupErrorKind::bad_argument, "the haptic loop was started already, and not stopped", "Call stop() first");
}

PALPATE_INLINE void HapticLoop::start(const LoopOptions& options) {
  require_startable(options);
  State& s = *state_;
  s.options = options;
  s.report = s.fresh_report();
  s.ticks = 0;
  s.force = s.elapsed = 0.0;
  s.duration = options.duration;
  s.cancel = false;
  std::fill(s.clocks.begin(), s.clocks.end(), StampClock{});
  s.devices.start();
  struct StopUnlessRunning {
    State& s;
    ~StopUnlessRunning() {
      if (!s.started) s.running = false, s.devices.stop();
    }
  } const guard{s};
  s.running = true;
  s.thread = std::thread([&s] { s.run(); });
  s.started = true;
}

PALPATE_INLINE LoopReport HapticLoop::stop() {
  State& s = *state_;
  if (!s.started) return s.fresh_report();
  const bool early = s.running && s.options.duration < infinity;
  s.end_thread();
  s.report.cancelled = early;
  return std::move(s.report);
}

PALPATE_INLINE LoopReport HapticLoop::run(const LoopOptions& options) {
  if (options.duration == infinity && !options.progress)
    raise(SetupErrorKind::bad_argument, "the haptic loop would never end",
          "Give LoopOptions a duration, or a progress callback that returns false to end the loop; or start a "
          "HapticSession and stop it");
  start(options);
  State& s = *state_;
  struct End {
    State& s;
    ~End() { s.end_thread(); }
  };
  bool cancelled = false;
  {
    const End end{s};
    std::unique_lock lock(s.mutex);
    while (!s.changed.wait_for(lock, std::chrono::milliseconds(100), [&] { return !s.running; })) {
      if (!options.progress || cancelled) continue;
      lock.unlock();
      cancelled = !options.progress(progress());
      if (cancelled) s.cancel = true;
      lock.lock();
    }
    lock.unlock();
  }
  s.report.cancelled = cancelled;
  return std::move(s.report);
}

PALPATE_INLINE bool HapticLoop::is_running() const noexcept {
  return state_->running.load(std::memory_order_acquire);
}
PALPATE_INLINE bool HapticLoop::is_started() const noexcept {
  return state_->started;
}
PALPATE_INLINE double HapticLoop::rate() const noexcept {
  return state_->rate;
}

PALPATE_INLINE LoopProgress HapticLoop::progress() const noexcept {
  LoopProgress p;
  p.ticks = state_->ticks.load(std::memory_order_relaxed);
  p.force = state_->force.load(std::memory_order_relaxed);
  p.elapsed = state_->elapsed.load(std::memory_order_relaxed);
  p.fraction = p.elapsed / state_->duration.load(std::memory_order_relaxed);
  return p;
}

}}}  // namespace palpate::detail
