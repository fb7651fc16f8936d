// Rendering without motors.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/limit_length.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate::inline PALPATE_ABI {

/// What a device without motors renders: the force it was told, within the peak; zero while stopped and while the last
/// read was invalid.
class VirtualMotors {
 public:
  /// Throws SetupError(bad_argument) unless the peak force is positive and finite.
  explicit VirtualMotors(const DeviceLimits& limits) : limits_(limits) {
    if (!(limits.peak_force > 0.0 && std::isfinite(limits.peak_force)))
      raise(SetupErrorKind::bad_argument, "the peak force of a device is " + number(limits.peak_force) + " N");
  }

  void start() noexcept { running_ = true; }
  void stop() noexcept {
    running_ = false;
    force_.setZero();
  }
  void read_was(bool valid) noexcept {
    readable_ = valid;
    if (!valid) force_.setZero();
  }
  /// Finite forces longer than the peak are shortened; others than finite ones become zero.
  Status render(const Vector3& force) noexcept {
    Status status;
    force_.setZero();
    if (!readable_) status.set(StatusFlag::disconnected);
    if (!force.allFinite()) status.set(StatusFlag::non_finite_force);
    if (!running_ || !status.ok()) return status;
    bool shortened = false;
    force_ = limit_length(force, limits_.peak_force, shortened);
    if (shortened) status.set(StatusFlag::saturated);
    peak_ = std::max(peak_, force_.norm());
    return status;
  }
  /// A torque, shortened to the peak torque where one is given.
  Vector3 torque(const Vector3& wanted) const noexcept {
    bool shortened = false;
    return limits_.peak_torque > 0.0 ? limit_length(wanted, limits_.peak_torque, shortened) : wanted;
  }
  const DeviceLimits& limits() const noexcept { return limits_; }
  const Vector3& force() const noexcept { return force_; }  ///< [N] what is rendered now
  double peak() const noexcept { return peak_; }            ///< [N] the most that was rendered so far

 private:
  DeviceLimits limits_;
  Vector3 force_ = Vector3::Zero();
  double peak_ = 0.0;
  bool running_ = false, readable_ = true;
};

}  // namespace palpate::inline PALPATE_ABI
