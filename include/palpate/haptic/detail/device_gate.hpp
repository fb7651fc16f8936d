// The last stage of a device that changes the forces of a session on their way to another device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The gate of such a device, with the state that was read last. A force belongs to one reading: where there was none
/// since the last force, the loop has ended, and the device gets none.
class DeviceGate {
 public:
  /// Throws bad_argument for an invalid rate [1/s].
  DeviceGate(const DeviceLimits& device, double rate) : gate_(ForceLimits::from(device, rate)) {}

  void take(const ToolState& state) noexcept;
  /// Of the tick, for a device that does not know the present time.
  void set_now(double now) noexcept { now_ = now; }
  /// The state of the last reading.
  const ToolState& state() const noexcept { return state_; }
  /// Whether no state was taken since the last call; the gate then begins again.
  bool lacks_state() noexcept;
  /// `force` and `torque` within the limits, with status and error of `given`, from which they were made.
  GatedForce pass(const Vector3& force, const Vector3& torque, const GatedForce& given, bool restart) noexcept;
  void reset() noexcept;

 private:
  ForceGate gate_;
  ToolState state_;
  double now_ = std::numeric_limits<double>::quiet_NaN();
  bool has_state_ = false;
};

/// Passes status and present time to a device that keeps a log.
template <class Device>
void forward_note(Device& device, Status status, double now) noexcept {
  if constexpr (requires { device.note(status, now); })
    device.note(status, now);
  else if constexpr (requires { device.note(status); })
    device.note(status);
}

/// Whether a replayed device has come to a start of the recorded one.
template <class Device>
bool has_restarted(const Device& device) noexcept {
  if constexpr (requires { device.restarts(); })
    return device.restarts();
  else
    return false;
}

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/detail/device_gate.ipp>
#endif
