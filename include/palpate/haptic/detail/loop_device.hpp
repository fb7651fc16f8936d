// Type-erased references to devices and servos.
#pragma once

#include <palpate/concepts/servo.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <concepts>
#include <tuple>
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

}}}  // namespace palpate::detail
