// Runs a device and a servo at a steady rate in a thread of their own and reports honestly how it went.
#pragma once

#include <palpate/concepts/servo.hpp>
#include <palpate/haptic/loop_report.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// [s] median of two clock readings in a row.
double measured_clock_cost() noexcept;

/// A device of any type, as the loop uses it.
struct LoopDevice {
  void* device;
  ToolState (*read)(void*) noexcept;
  Status (*write)(void*, const GatedForce&) noexcept;
  void (*note)(void*, Status) noexcept;  // null: it takes no notes
  void (*start)(void*);
  void (*stop)(void*) noexcept;
};

/// A servo of any type.
struct LoopServo {
  void* servo;
  std::span<const GatedForce> (*tick)(void*, std::span<const ToolState>) noexcept;
};

LoopReport run_loop(const LoopDevice& device, const LoopServo& servo, const LoopOptions& options);

template <HapticDevice D>
LoopDevice loop_device(D& device) noexcept {
  LoopDevice view{&device,
                  [](void* d) noexcept { return static_cast<D*>(d)->read(); },
                  [](void* d, const GatedForce& force) noexcept { return static_cast<D*>(d)->write(force); },
                  nullptr,
                  [](void* d) { static_cast<D*>(d)->start(); },
                  [](void* d) noexcept { static_cast<D*>(d)->stop(); }};
  if constexpr (requires(Status status) { device.note(status); })
    view.note = [](void* d, Status status) noexcept { static_cast<D*>(d)->note(status); };
  return view;
}

}  // namespace detail

/// Starts the device and, in a thread of its own with denormals flushed, each period reads it, ticks the servo with
/// that one state and writes the force; then stops the device, whatever happens. Returns when `duration` is over or the
/// progress callback said so. A tick takes no lock and allocates nothing of its own. Forces are written as the servo
/// gives them: the force gate is the servo's last step. If the device has note(Status) (a Recorder), it is given each
/// tick's status. Throws SetupError(bad_argument) on senseless options, and what device.start() and the callback throw.
template <HapticDevice Device, Servo S>
LoopReport run_haptic_loop(Device& device, S& servo, const LoopOptions& options = {}) {
  const detail::LoopServo view{
      &servo, [](void* s, std::span<const ToolState> states) noexcept { return static_cast<S*>(s)->tick(states); }};
  return detail::run_loop(detail::loop_device(device), view, options);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/run_haptic_loop.ipp>
#endif
