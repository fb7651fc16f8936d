// Limits of the force that a device sends to its motors; the last stage of every device's write.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// The limits of a device that renders torque, or does not: without `torque`, peak torque and rotational stiffness are
/// set to zero. Throws SetupError(bad_argument) with `torque` unless both are positive and finite.
DeviceLimits with_torque(DeviceLimits limits, bool torque);

}  // namespace detail

/// Limits a commanded force to what a device renders: force and torque within their peaks; zero while stopped and while
/// the last read was invalid. No allocation, no throw after construction.
class RenderLimits {
 public:
  /// Throws SetupError(bad_argument) unless the peak force is positive and finite, and the peak torque finite and not
  /// negative.
  explicit RenderLimits(const DeviceLimits& limits);

  void start() noexcept { running_ = true; }
  void stop() noexcept;
  void read_was(bool valid) noexcept;
  /// A force or torque above its peak is shortened, `saturated`; a peak torque of zero gives none. If one of the two is
  /// not finite (a placement may scale it beyond the range of a double), both are zero, `non_finite_force`.
  Status render(const GatedForce& wanted) noexcept;
  const DeviceLimits& limits() const noexcept { return limits_; }
  const Vector3& force() const noexcept { return force_; }    ///< [N] rendered now
  const Vector3& torque() const noexcept { return torque_; }  ///< [N m] the same
  double peak() const noexcept { return peak_; }              ///< [N] largest force rendered so far

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
