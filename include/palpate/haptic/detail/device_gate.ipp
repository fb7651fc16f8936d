// Definitions of device_gate.hpp.
#pragma once

#include <palpate/haptic/detail/device_gate.hpp>

#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void DeviceGate::take(const ToolState& state) noexcept {
  state_ = state;
  has_state_ = true;
}

PALPATE_INLINE bool DeviceGate::lacks_state() noexcept {
  if (std::exchange(has_state_, false)) return false;
  reset();
  return true;
}

PALPATE_INLINE GatedForce DeviceGate::pass(const Vector3& force, const Vector3& torque, const GatedForce& given,
                                           bool restart) noexcept {
  const double now = std::isfinite(state_.now) ? state_.now : std::isfinite(now_) ? now_ : state_.time;
  GatedForce passed = gate_.apply(force, torque, now, state_.time, state_.valid, restart);
  passed.status |= given.status;
  passed.error = given.error;
  return passed;
}

PALPATE_INLINE void DeviceGate::reset() noexcept {
  gate_.reset();
  now_ = std::numeric_limits<double>::quiet_NaN();
  has_state_ = state_.valid = false;
}

}}}  // namespace palpate::detail
