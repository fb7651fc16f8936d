// A device of a type that is chosen when the program starts, and what the window gets to see of its ticks.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/device/recorder.hpp>

#include <utility>

namespace live {

using namespace palpate;

/// A HapticDevice behind virtual functions.
class AnyDevice {
 public:
  virtual ~AnyDevice() = default;
  virtual ToolState read() noexcept = 0;
  virtual Status write(const GatedForce& force) noexcept = 0;
  virtual DeviceLimits limits() const noexcept = 0;
  virtual void start() = 0;
  virtual void stop() noexcept = 0;
};

template <HapticDevice Device>
class DeviceOf final : public AnyDevice {
 public:
  template <class... Arguments>
  explicit DeviceOf(Arguments&&... arguments) : device(std::forward<Arguments>(arguments)...) {}
  ToolState read() noexcept override { return device.read(); }
  Status write(const GatedForce& force) noexcept override { return device.write(force); }
  DeviceLimits limits() const noexcept override { return device.limits(); }
  void start() override { device.start(); }
  void stop() noexcept override { device.stop(); }

  Device device;
};

/// One tick of one tool, for charts and recordings.
struct TickSample {
  RecordedTick tick;
  double compute = 0.0;  ///< [s] processor time from read to write: the tick of the servo
  double period = 0.0;   ///< [s] wall time since the last read
};

/// Between a device and the loop: passes everything on, and hands a copy of every tick to the window. What the window
/// has not fetched for eight seconds is dropped.
class Tap {
 public:
  /// `paced`: the loop is in real time, so that the time between two reads means something.
  Tap(AnyDevice& device, bool paced) noexcept : device_(&device), paced_(paced) {}

  ToolState read() noexcept {
    const std::int64_t wall = platform::wall_ns();
    sample_ = {};
    sample_.period = paced_ && last_ > 0 ? 1e-9 * static_cast<double>(wall - last_) : 0.0;
    last_ = wall;
    sample_.tick.state = device_->read();
    sample_.tick.starts = std::exchange(starting_, false);
    unanswered_ = true;
    started_ = platform::compute_ns();
    return sample_.tick.state;
  }
  Status write(const GatedForce& force) noexcept {
    sample_.compute = 1e-9 * static_cast<double>(platform::compute_ns() - started_);
    const Status status = device_->write(force);
    if (!std::exchange(unanswered_, false)) return status;  // the zero at the end of the loop
    sample_.tick.force = force.force();
    sample_.tick.expected_error = force.error.expected;
    sample_.tick.error_bound = force.error.bound;
    sample_.tick.status |= status | force.status;
    samples_.push(sample_);
    return status;
  }
  /// The present time that the loop has set.
  void note(Status, double now) noexcept { sample_.tick.state.now = now; }
  DeviceLimits limits() const noexcept { return device_->limits(); }
  void start() {
    last_ = 0;
    device_->start();
    starting_ = true;
  }
  void stop() noexcept { device_->stop(); }

  // The thread of the window
  bool pop(TickSample& sample) noexcept { return samples_.pop(sample); }

 private:
  AnyDevice* device_;
  bool paced_, starting_ = false, unanswered_ = false;
  TickSample sample_;
  std::int64_t last_ = 0, started_ = 0;
  SpscRing<TickSample, 8192> samples_;
};

static_assert(HapticDevice<AnyDevice> && HapticDevice<Tap>);

}  // namespace live
