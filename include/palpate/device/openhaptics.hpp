// OpenHaptics (HDAPI 3): Touch, Phantom Omni, Desktop, Premium. Include <HD/hd.h> before this header, or define
// PALPATE_INCLUDE_OPENHAPTICS to have it included with what it needs. Link libHD. Tested against a fake written for
// this project, never on hardware: run testing/device_laws.hpp on your device, with no hand on the handle.
#pragma once

#ifdef PALPATE_INCLUDE_OPENHAPTICS
#include <chrono>
#include <cstddef>  // HD_DEFAULT_DEVICE is NULL
#if defined(__linux__) && !defined(linux)
#define linux 1  // needed by the SDK, not defined in strict C++
#define PALPATE_DEFINED_LINUX
#endif
#include <HD/hd.h>
#ifdef PALPATE_DEFINED_LINUX
#undef linux
#undef PALPATE_DEFINED_LINUX
#endif
#endif
#ifndef HD_CURRENT_POSITION
#error "palpate/device/openhaptics.hpp: include <HD/hd.h> first, or define PALPATE_INCLUDE_OPENHAPTICS"
#endif

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/device/detail/sdk_state.hpp>
#include <palpate/device/render_limits.hpp>

#include <array>
#include <atomic>
#include <optional>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

struct OpenHapticsOptions {
  const char* name = nullptr;          ///< name in the vendor's set-up tool; null: the default device
  bool torque = false;                 ///< the device has motors for torque; needs `limits`
  std::optional<DeviceLimits> limits;  ///< instead of those of the SDK, which has none for torque
};

/// A device of HDAPI as a HapticDevice, in the device's frame: x to the right, y up, z to the user. Millimetres and
/// newton millimetres of the SDK are converted here. `read` begins the SDK's frame and `write` ends it, which sends the
/// force: call both from the SDK's callback only, as OpenHapticsLoop does, so that a force is sent in the frame in
/// which its position was read. The SDK's errors are checked twice per frame. The five about force (motors warm, too
/// much force, impulse or speed) set `saturated`; any other makes the read invalid or the write `disconnected`, without
/// force.
class OpenHapticsDevice {
 public:
  /// Opens the device and reads its limits. Throws SetupError(unsupported) with the SDK's message when that fails,
  /// (bad_argument) when a limit of the SDK is not finite or not positive, and for torque without limits for it.
  explicit OpenHapticsDevice(const OpenHapticsOptions& options = {})
      : options_(options), handle_(open(options.name)), rendered_(DeviceLimits{}) {
    const auto limit = [&] {
      rendered_ = RenderLimits(detail::with_torque(options_.limits ? *options_.limits : sdk_limits(), options_.torque));
    };
    detail::run_or_undo(limit, [&] { hdDisableDevice(handle_); });
  }
  ~OpenHapticsDevice() {
    stop();
    hdDisableDevice(handle_);
  }
  OpenHapticsDevice(const OpenHapticsDevice&) = delete;
  OpenHapticsDevice& operator=(const OpenHapticsDevice&) = delete;

  ToolState read() noexcept {
    if (in_frame_) write(GatedForce{});  // the last frame was never written
    hdBeginFrame(handle_);
    in_frame_ = true;
    ToolState state = state_of_frame();
    const Status errors = take_errors();
    state.valid = !errors.has(StatusFlag::disconnected) && all_finite(state.position);
    if (!all_finite(state.position)) state.position.setZero();
    rendered_.read_was(state.valid);
    return state;
  }

  Status write(const GatedForce& force) noexcept {
    const Status status = rendered_.render(force);
    if (!in_frame_) return status | StatusFlag::disconnected;
    hdSetDoublev(HD_CURRENT_FORCE, rendered_.force().data());
    if (options_.torque) send_torque(rendered_.torque());
    hdEndFrame(handle_);
    in_frame_ = false;
    return status | take_errors();
  }

  DeviceLimits limits() const noexcept { return rendered_.limits(); }

  /// Enables forces. Throws SetupError(unsupported) when the SDK does not.
  void start() {
    hdMakeCurrentDevice(handle_);
    hdEnable(HD_FORCE_OUTPUT);
    require_no_error("enable its force");
    running_ = true;
    rendered_.start();
  }
  /// Disables forces. For the thread of the callback, or after that has ended.
  void stop() noexcept {
    if (in_frame_) write(GatedForce{});
    if (running_) {
      hdMakeCurrentDevice(handle_);
      hdDisable(HD_FORCE_OUTPUT);
    }
    running_ = false;
    rendered_.stop();
  }

  const Vector3& last_force() const noexcept { return rendered_.force(); }    ///< [N] rendered last
  const Vector3& last_torque() const noexcept { return rendered_.torque(); }  ///< [N m] the same
  HHD handle() const noexcept { return handle_; }
  /// The newest error that was not about force, HD_SUCCESS when there was none. For any thread.
  HDerror last_error() const noexcept { return last_error_.load(std::memory_order_relaxed); }

 private:
  [[noreturn]] static void refuse(const std::string& what, const HDErrorInfo& error) {
    raise(SetupErrorKind::unsupported,
          "OpenHaptics could not " + what + ": " + std::string(hdGetErrorString(error.errorCode)),
          "Try the device with the vendor's own diagnostic program first");
  }
  static void require_no_error(const std::string& what) {
    const HDErrorInfo error = hdGetError();
    if (HD_DEVICE_ERROR(error)) refuse(what, error);
  }
  static HHD open(const char* name) {
    const HHD handle = hdInitDevice(name ? name : HD_DEFAULT_DEVICE);
    require_no_error("open the device");
    return handle;
  }

  static double read_limit(HDenum parameter, double scale, const char* what) {
    std::array<HDdouble, 16> values{};  // room for the largest parameter, in case a driver writes too much
    hdGetDoublev(parameter, values.data());
    const HDdouble value = values[0];
    require_no_error(std::string("report its ") + what);
    if (!(std::isfinite(value) && value > 0.0))
      raise(SetupErrorKind::bad_argument, std::string("OpenHaptics reports that its ") + what + " is " + number(value),
            "Give OpenHapticsOptions::limits");
    return scale * value;
  }
  DeviceLimits sdk_limits() const {
    hdMakeCurrentDevice(handle_);
    DeviceLimits limits;
    limits.peak_force = read_limit(HD_NOMINAL_MAX_FORCE, 1.0, "largest force");
    limits.continuous_force =
        std::min(read_limit(HD_NOMINAL_MAX_CONTINUOUS_FORCE, 1.0, "continuous force"), limits.peak_force);
    limits.stiffness = read_limit(HD_NOMINAL_MAX_STIFFNESS, 1e3, "largest stiffness");  // N/mm
    std::array<HDdouble, 6> box{};
    hdGetDoublev(HD_USABLE_WORKSPACE_DIMENSIONS, box.data());
    require_no_error("report its workspace");
    limits.workspace_low = 1e-3 * Vector3(box[0], box[1], box[2]);
    limits.workspace_high = 1e-3 * Vector3(box[3], box[4], box[5]);
    if (!((limits.workspace_high - limits.workspace_low).minCoeff() > 0.0))
      raise(SetupErrorKind::bad_argument, "OpenHaptics reports that its workspace is empty",
            "Give OpenHapticsOptions::limits");
    return limits;
  }

  ToolState state_of_frame() const noexcept {
    std::array<HDdouble, 3> position{}, velocity{};
    std::array<HDdouble, 16> transform{};
    HDint buttons = 0;
    hdGetDoublev(HD_CURRENT_POSITION, position.data());
    hdGetDoublev(HD_CURRENT_VELOCITY, velocity.data());
    hdGetDoublev(HD_CURRENT_TRANSFORM, transform.data());
    hdGetIntegerv(HD_CURRENT_BUTTONS, &buttons);
    ToolState state;
    state.time = clock_.now();
    state.position = 1e-3 * Vector3(position[0], position[1], position[2]);
    const Vector3 v = 1e-3 * Vector3(velocity[0], velocity[1], velocity[2]);
    if (all_finite(v)) state.velocity = v;
    Matrix3 rotation;
    rotation << transform[0], transform[4], transform[8], transform[1], transform[5], transform[9], transform[2],
        transform[6], transform[10];
    detail::orient(state, rotation);
    state.buttons = static_cast<std::uint32_t>(buttons);
    return state;
  }

  void send_torque(const Vector3& torque) const noexcept {
    const Vector3 sent = 1e3 * torque;  // mN m
#ifdef HD_CURRENT_GIMBAL_TORQUE
    hdSetDoublev(HD_CURRENT_GIMBAL_TORQUE, sent.data());
#else
    hdSetDoublev(HD_CURRENT_TORQUE, sent.data());
#endif
  }

  static bool is_about_force(HDerror code) noexcept {
    return code == HD_WARM_MOTORS || code == HD_EXCEEDED_MAX_FORCE || code == HD_EXCEEDED_MAX_FORCE_IMPULSE ||
           code == HD_EXCEEDED_MAX_VELOCITY || code == HD_FORCE_ERROR;
  }
  /// Empties the stack of errors, up to a bound.
  Status take_errors() noexcept {
    Status status;
    for (int i = 0; i < 16; ++i) {
      const HDErrorInfo error = hdGetError();
      if (!(HD_DEVICE_ERROR(error))) break;
      if (is_about_force(error.errorCode)) {
        status.set(StatusFlag::saturated);
      } else {
        status.set(StatusFlag::disconnected);
        last_error_.store(error.errorCode, std::memory_order_relaxed);
      }
    }
    return status;
  }

  OpenHapticsOptions options_;
  HHD handle_;
  RenderLimits rendered_;
  detail::SteadyStamp clock_;
  std::atomic<HDerror> last_error_{HD_SUCCESS};
  bool in_frame_ = false, running_ = false;
};

static_assert(HapticDevice<OpenHapticsDevice>);

/// Runs a servo in the SDK's own thread: one callback of the highest priority that reads, ticks and writes. Ends by
/// itself, with zero force, when the device is lost. Refers to device and servo, which must outlive it. One loop per
/// process at a time: scheduler, rate and stack of errors belong to the process.
template <Servo S>
class OpenHapticsLoop {
 public:
  OpenHapticsLoop(OpenHapticsDevice& device, S& servo) : device_(device), servo_(servo) {}
  ~OpenHapticsLoop() { stop(); }
  OpenHapticsLoop(const OpenHapticsLoop&) = delete;
  OpenHapticsLoop& operator=(const OpenHapticsLoop&) = delete;

  /// Starts the device, then the callback and the scheduler at `rate` [1/s] (500 and 1000 are typical), and waits for
  /// the first tick. Throws SetupError(unsupported) when no tick follows within a second: after the scheduler has
  /// started, only the callback reads the stack of errors; (bad_argument) after a start without a stop.
  void start(unsigned rate = 1000) {
    if (scheduled_)
      raise(SetupErrorKind::bad_argument, "this OpenHaptics loop was started already", "Call stop() first");
    device_.start();
    ticks_ = 0;
    last_status_ = Status();
    hdSetSchedulerRate(rate);
    scheduled_ = true;
    alive_ = true;
    callback_ = hdScheduleAsynchronous(&OpenHapticsLoop::tick, this, HD_MAX_SCHEDULER_PRIORITY);
    const auto begin = [&] {
      hdStartScheduler();
      for (int i = 0; ticks() == 0 && i < 1000; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (ticks() == 0)
        raise(SetupErrorKind::unsupported, "the OpenHaptics scheduler does not call the callback",
              "Is another program using the device, or is " + std::to_string(rate) + " Hz not one of its rates?");
    };
    detail::run_or_undo(begin, [&] { stop(); });
  }
  void stop() noexcept {
    if (!scheduled_) return;
    hdStopScheduler();
    hdUnschedule(callback_);
    scheduled_ = false;
    alive_ = false;
    device_.stop();
  }

  bool alive() const noexcept { return alive_.load(); }                ///< false once the device was lost
  std::uint64_t ticks() const noexcept { return ticks_.load(); }       ///< since the start
  Status last_status() const noexcept { return last_status_.load(); }  ///< of the last tick

 private:
  static HDCallbackCode HDCALLBACK tick(void* self) { return static_cast<OpenHapticsLoop*>(self)->tick(); }
  HDCallbackCode tick() noexcept {
    const ToolState state = device_.read();
    const std::span<const GatedForce> forces = servo_.tick(std::span<const ToolState>(&state, 1));
    const GatedForce force = forces.empty() ? GatedForce{} : forces.front();
    const Status status = force.status | device_.write(force);
    last_status_.store(status, std::memory_order_relaxed);
    ticks_.fetch_add(1, std::memory_order_relaxed);
    if (state.valid && !status.has(StatusFlag::disconnected)) return HD_CALLBACK_CONTINUE;
    if (state.valid) {  // this frame has sent its force although it failed: one more frame removes it
      device_.read();
      device_.write(GatedForce{});
    }
    alive_.store(false);
    return HD_CALLBACK_DONE;
  }

  OpenHapticsDevice& device_;
  S& servo_;
  HDSchedulerHandle callback_{};
  std::atomic<std::uint64_t> ticks_{0};
  std::atomic<Status> last_status_{};
  std::atomic<bool> alive_{false};
  bool scheduled_ = false;
};

}}  // namespace palpate
