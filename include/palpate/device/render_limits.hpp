// The last lines of every device's write: what goes to its motors.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// The limits of a device that is told to render torque, or none: without, it has no peak torque and no turning
/// stiffness. Throws SetupError(bad_argument) when it is, and one of the two is not positive and finite.
DeviceLimits with_torque(DeviceLimits limits, bool torque);

/// What a device renders of what it is told: force and torque within their peaks; none while stopped and while the last
/// read was invalid. No allocation, no throw after construction.
class RenderLimits {
 public:
  /// Throws SetupError(bad_argument) unless the peak force is positive and finite, and the peak torque finite and not
  /// negative.
  explicit RenderLimits(const DeviceLimits& limits);

  void start() noexcept { running_ = true; }
  void stop() noexcept;
  void read_was(bool valid) noexcept;
  /// Longer than its peak: shortened, `saturated`; a peak torque of zero leaves none. Where one of the two is not finite
  /// (a placement may scale it beyond the range of a double), both are zero, `non_finite_force`.
  Status render(const GatedForce& wanted) noexcept;
  const DeviceLimits& limits() const noexcept { return limits_; }
  const Vector3& force() const noexcept { return force_; }    ///< [N] what is rendered now
  const Vector3& torque() const noexcept { return torque_; }  ///< [N m] the same
  double peak() const noexcept { return peak_; }              ///< [N] the most that was rendered so far

 private:
  void silence() noexcept;
  static Vector3 within(double most, const Vector3& wanted, Status& status) noexcept;

  DeviceLimits limits_;
  Vector3 force_ = Vector3::Zero(), torque_ = Vector3::Zero();
  double peak_ = 0.0;
  bool running_ = false, readable_ = true;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/render_limits.ipp>
#endif
