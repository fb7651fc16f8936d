// The mouse as a haptic device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/device/mock_device.hpp>

namespace live {

using namespace palpate;

/// What the pointer asks of the tool.
struct PointerTarget {
  Vector3 position = Vector3::Zero();  ///< [m] world
  std::uint32_t buttons = 0;
  bool set_there = false;  ///< true: the tool is at once where the pointer sets it; false: it follows smoothly
  bool plugged = true;     ///< false: as a device whose cable was pulled
};

/// A HapticDevice that follows the pointer. A mouse reports positions some sixty times a second; the device follows the
/// last one as a critically damped mass on a spring, so that the tool moves smoothly at the rate of the haptic loop.
/// The position is a function of the targets and of the number of reads only. Forces are limited as by any device;
/// nothing renders them but the picture.
class MouseDevice {
 public:
  static constexpr double rate = 1000.0;     ///< [1/s]
  static constexpr double quickness = 60.0;  ///< [1/s] the tool is there after about 0.1 s
  static constexpr double most_speed = 0.5;  ///< [m/s] as a quick hand: a pointer that leaps is followed, not its leap

  MouseDevice(const Vector3& start, DeviceClock clock);

  // The thread of the window
  /// False when the haptic thread has not read for a long time.
  bool move(const PointerTarget& target) noexcept { return targets_.push(target); }

  // The haptic thread
  ToolState read() noexcept;
  Status write(const GatedForce& force) noexcept { return rendered_.render(force); }
  DeviceLimits limits() const noexcept { return rendered_.limits(); }
  void start() noexcept { rendered_.start(); }
  void stop() noexcept { rendered_.stop(); }
  const Vector3& last_force() const noexcept { return rendered_.force(); }  ///< [N] rendered now

 private:
  double now() const noexcept;
  void follow() noexcept;

  SpscRing<PointerTarget, 1024> targets_;
  PointerTarget target_;
  Vector3 position_, velocity_ = Vector3::Zero();
  DeviceClock clock_;
  std::uint64_t reads_ = 0;
  RenderLimits rendered_;
};

static_assert(HapticDevice<MouseDevice>);

}  // namespace live
