// Definitions of render_limits.hpp.
#pragma once

#include <palpate/device/render_limits.hpp>
#include <palpate/core/detail/limit_length.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE DeviceLimits with_torque(DeviceLimits limits, bool torque) {
  if (!torque) limits.peak_torque = limits.rotational_stiffness = 0.0;
  for (const double value : {limits.peak_torque, limits.rotational_stiffness})
    if (torque && !(value > 0.0 && std::isfinite(value)))
      raise(SetupErrorKind::bad_argument,
            "a device that renders torque has a peak torque of " + number(limits.peak_torque) +
                " N m and a rotational stiffness of " + number(limits.rotational_stiffness) + " N m/rad",
            "Give both in the option `limits`, from the data sheet");
  return limits;
}

}  // namespace detail

PALPATE_INLINE RenderLimits::RenderLimits(const DeviceLimits& limits) : limits_(limits) {
  if (!(limits.peak_force > 0.0 && std::isfinite(limits.peak_force)))
    raise(SetupErrorKind::bad_argument, "the peak force of a device is " + number(limits.peak_force) + " N");
  if (!(limits.peak_torque >= 0.0 && std::isfinite(limits.peak_torque)))
    raise(SetupErrorKind::bad_argument, "the peak torque of a device is " + number(limits.peak_torque) + " N m");
}

PALPATE_INLINE void RenderLimits::stop() noexcept {
  running_ = false;
  silence();
}

PALPATE_INLINE void RenderLimits::read_was(bool valid) noexcept {
  readable_ = valid;
  if (!valid) silence();
}

PALPATE_INLINE Status RenderLimits::render(const GatedForce& wanted) noexcept {
  Status status;
  silence();
  if (!readable_) status.set(StatusFlag::disconnected);
  if (!all_finite(wanted.force()) || !all_finite(wanted.torque())) status.set(StatusFlag::non_finite_force);
  if (!running_ || !status.ok()) return status;
  force_ = within(limits_.peak_force, wanted.force(), status);
  torque_ = within(limits_.peak_torque, wanted.torque(), status);
  peak_ = std::max(peak_, force_.norm());
  return status;
}

PALPATE_INLINE void RenderLimits::silence() noexcept {
  force_.setZero();
  torque_.setZero();
}

PALPATE_INLINE Vector3 RenderLimits::within(double most, const Vector3& wanted, Status& status) noexcept {
  bool shortened = false;
  const Vector3 given = detail::limit_length(wanted, most, shortened);
  if (shortened) status.set(StatusFlag::saturated);
  return given;
}

}}  // namespace palpate
