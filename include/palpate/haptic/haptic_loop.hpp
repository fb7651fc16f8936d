// The thread that serves devices and a servo at a constant rate, and run_haptic_loop for a user-defined servo.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/haptic/loop_report.hpp>

#include <concepts>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A reference to a device, with its functions.
struct LoopDevice {
  void* device;
  ToolState (*read)(void*) noexcept;
  Status (*write)(void*, const GatedForce&) noexcept;
  void (*note)(void*, Status, double now) noexcept;  // null: the device has no such function
  bool (*restarts)(const void*) noexcept;            // null: the same
  void (*start)(void*);
  void (*stop)(void*) noexcept;
  DeviceLimits (*limits)(const void*) noexcept;
};

/// A reference to a servo.
struct LoopServo {
  void* servo;
  std::span<const GatedForce> (*tick)(void*, std::span<const ToolState>) noexcept;
  double slowest_rate;  ///< [1/s] slower ticks count as missed; 0: the servo does not state its gate's limits
  void (*reset)(void*) noexcept = nullptr;  ///< before the tick in which a device restarts; null: nothing
};

template <HapticDevice D>
LoopDevice loop_device(D& device) noexcept {
  LoopDevice view{&device,
                  [](void* d) noexcept { return static_cast<D*>(d)->read(); },
                  [](void* d, const GatedForce& force) noexcept { return static_cast<D*>(d)->write(force); },
                  nullptr,
                  nullptr,
                  [](void* d) { static_cast<D*>(d)->start(); },
                  [](void* d) noexcept { static_cast<D*>(d)->stop(); },
                  [](const void* d) noexcept { return static_cast<const D*>(d)->limits(); }};
  if constexpr (requires(Status status, double now) { device.note(status, now); })
    view.note = [](void* d, Status status, double now) noexcept { static_cast<D*>(d)->note(status, now); };
  else if constexpr (requires(Status status) { device.note(status); })
    view.note = [](void* d, Status status, double) noexcept { static_cast<D*>(d)->note(status); };
  if constexpr (requires(const D& constant) { constant.restarts(); })
    view.restarts = [](const void* d) noexcept -> bool { return static_cast<const D*>(d)->restarts(); };
  return view;
}
template <HapticDevice... D>
std::vector<LoopDevice> loop_devices(const std::tuple<D&...>& devices) {
  return std::apply([](D&... d) { return std::vector<LoopDevice>{loop_device(d)...}; }, devices);
}

template <Servo S>
LoopServo loop_servo(S& servo) noexcept {
  LoopServo view{&servo,
                 [](void* s, std::span<const ToolState> states) noexcept { return static_cast<S*>(s)->tick(states); },
                 0.0};
  if constexpr (requires {
                  { servo.limits() } -> std::convertible_to<ForceLimits>;
                })
    view.slowest_rate = ForceLimits(servo.limits()).slowest_rate();
  return view;
}

/// Median difference of two consecutive clock readings [s].
double measured_clock_cost() noexcept;

/// The rate of a loop over devices [1/s]: that of the slowest device.
double rate_of(const std::vector<LoopDevice>& devices) noexcept;

/// Starts devices and, in its own thread, in each period reads all, ticks the servo once and writes all. State and
/// force number i are those of device i. Refers to devices and servo.
class HapticLoop {
 public:
  /// Throws bad_argument without a device, for one given twice (ids: its numbers), for a rate outside 0.1 to 1e5, and
  /// for one so low that the servo's gate would take every tick as missed (value and threshold: rates).
  HapticLoop(std::vector<LoopDevice> devices, const LoopServo& servo, double rate);
  /// Stops as `stop` does.
  ~HapticLoop();

  /// Throws bad_argument for an invalid duration, or when it was started and not stopped.
  void require_startable(const LoopOptions& options) const;
  /// Throws as require_startable, and what a device throws that cannot start; then that device and all before it are
  /// stopped, and no thread runs.
  void start(const LoopOptions& options);
  /// Ends and joins the thread, stops all devices, last one first. The report is empty when nothing was started.
  LoopReport stop();
  /// Starts, calls the progress callback until the loop ends, stops; also stops when the callback throws. Throws as
  /// start, and bad_argument for a loop that would never end: neither a duration nor a progress callback.
  LoopReport run(const LoopOptions& options);

  // Any thread
  bool is_running() const noexcept;
  LoopProgress progress() const noexcept;

  // The thread that starts and stops
  bool is_started() const noexcept;
  double rate() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

inline LoopReport run_loop(std::vector<LoopDevice> devices, const LoopServo& servo, const LoopOptions& options) {
  const double rate = rate_of(devices);
  return HapticLoop(std::move(devices), servo, rate).run(options);
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

/// For a user-defined servo; HapticSession constructs one that fits the device. Starts the device and, in its own
/// thread with denormals flushed, in each period of the device's rate reads it, ticks the servo with that one state and
/// writes the force; then stops the device in all cases. Returns when `duration` has passed or the progress callback
/// returned false; one of the two must be given. A tick takes no lock and allocates nothing itself. In
/// a paced loop ToolState::now is set where the device does not give it. Forces are
/// written as the servo returns them: the force gate is the servo's last step. If the device has note(Status), or
/// note(Status, now) as a Recorder, it receives each tick's status, and the present time. Throws
/// SetupError(bad_argument) for invalid options, and what device.start() and the callback throw. If the servo has
/// limits() (HapticServo), a loop that is slower than its rate by a factor of ForceLimits::late_factor or more is
/// refused (bad_argument; value and threshold are rates): every tick would count as missed. A loop that is faster than
/// the servo's rate is accepted: the gate's limits are per second and its steps no longer than the time that passed,
/// and the coupling for a lower rate is the softer one.
template <HapticDevice Device, Servo S>
LoopReport run_haptic_loop(Device& device, S& servo, const LoopOptions& options) {
  return detail::run_loop({detail::loop_device(device)}, detail::loop_servo(servo), options);
}
/// The same for several devices, std::tie(left, right), at the rate of the slowest: each tick reads all, ticks the
/// servo once and writes all. State and force number i are those of device i. They start in order; when one throws, it
/// and those before it are stopped.
template <HapticDevice... Device, Servo S>
LoopReport run_haptic_loop(const std::tuple<Device&...>& devices, S& servo, const LoopOptions& options) {
  return detail::run_loop(detail::loop_devices(devices), detail::loop_servo(servo), options);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/haptic_loop.ipp>
#endif
