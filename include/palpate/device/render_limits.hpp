// The last lines of every device's write: what goes to its motors.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/limit_length.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// The limits of a device that is told to render torque, or none: without, it has no peak torque and no turning
/// stiffness. Throws SetupError(bad_argument) when it is, and one of the two is not positive and finite.
inline DeviceLimits with_torque(DeviceLimits limits, bool torque) {
  if (!torque) limits.peak_torque = limits.turning_stiffness = 0.0;
  for (const double value : {limits.peak_torque, limits.turning_stiffness})
    if (torque && !(value > 0.0 && std::isfinite(value)))
      raise(SetupErrorKind::bad_argument,
            "a device that renders torque has a peak torque of " + number(limits.peak_torque) +
                " N m and a turning stiffness of " + number(limits.turning_stiffness) + " N m/rad",
            "Give both in the option `limits`, from the data sheet");
  return limits;
}

/// What a device renders of what it is told: force and torque within their peaks; none while stopped and while the last
/// read was invalid. No allocation, no throw after construction.
class RenderLimits {
 public:
  /// Throws SetupError(bad_argument) unless the peak force is positive and finite, and the peak torque finite and not
  /// negative.
  explicit RenderLimits(const DeviceLimits& limits) : limits_(limits) {
    if (!(limits.peak_force > 0.0 && std::isfinite(limits.peak_force)))
      raise(SetupErrorKind::bad_argument, "the peak force of a device is " + number(limits.peak_force) + " N");
    if (!(limits.peak_torque >= 0.0 && std::isfinite(limits.peak_torque)))
      raise(SetupErrorKind::bad_argument, "the peak torque of a device is " + number(limits.peak_torque) + " N m");
  }

  void start() noexcept { running_ = true; }
  void stop() noexcept {
    running_ = false;
    silence();
  }
  void read_was(bool valid) noexcept {
    readable_ = valid;
    if (!valid) silence();
  }
  /// Longer than its peak: shortened, `saturated`; a peak torque of zero leaves none. Where a component of one of the
  /// two is not finite, both are zero, `non_finite_force`.
  Status render(const Vector3& force, const Vector3& torque) noexcept {
    Status status;
    silence();
    if (!readable_) status.set(StatusFlag::disconnected);
    if (!force.allFinite() || !torque.allFinite()) status.set(StatusFlag::non_finite_force);
    if (!running_ || !status.ok()) return status;
    force_ = within(limits_.peak_force, force, status);
    torque_ = within(limits_.peak_torque, torque, status);
    peak_ = std::max(peak_, force_.norm());
    return status;
  }
  const DeviceLimits& limits() const noexcept { return limits_; }
  const Vector3& force() const noexcept { return force_; }    ///< [N] what is rendered now
  const Vector3& torque() const noexcept { return torque_; }  ///< [N m] the same
  double peak() const noexcept { return peak_; }              ///< [N] the most that was rendered so far

 private:
  void silence() noexcept {
    force_.setZero();
    torque_.setZero();
  }
  static Vector3 within(double most, const Vector3& wanted, Status& status) noexcept {
    bool shortened = false;
    const Vector3 given = limit_length(wanted, most, shortened);
    if (shortened) status.set(StatusFlag::saturated);
    return given;
  }

  DeviceLimits limits_;
  Vector3 force_ = Vector3::Zero(), torque_ = Vector3::Zero();
  double peak_ = 0.0;
  bool running_ = false, readable_ = true;
};

}}  // namespace palpate
