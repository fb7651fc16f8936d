// Definitions of force_gate.hpp.
#pragma once

#include <palpate/core/detail/limit_length.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ForceLimits ForceLimits::from(const DeviceLimits& device, double rate) {
  ForceLimits limits;
  limits.peak_force = device.peak_force;
  limits.slew_rate = 500.0 * device.peak_force;
  limits.period = 1.0 / rate;
  limits.stale_after = std::max(limits.stale_after, 3.0 * limits.period);
  limits.peak_torque = device.peak_torque;
  limits.continuous_force = device.continuous_force;
  return limits;
}

PALPATE_INLINE ForceGate::ForceGate(const ForceLimits& limits) : limits_(limits) {
  const ForceLimits& l = limits;
  for (double value : {l.peak_force, l.slew_rate, l.ramp_time, l.stale_after, l.fade_time, l.period, l.continuous_force,
                       l.heating_time, l.peak_torque == 0.0 ? l.period : l.peak_torque})
    require(value >= 1e-9 && value <= 1e9, "a force limit is " + number(value), "Give 1e-9 to 1e9, in SI units");
  require(l.slew_rate * l.fade_time >= l.peak_force * (1.0 - 1e-9),
          "slew_rate * fade_time is less than peak_force, " + number(l.peak_force) + " N", "Raise one of the two");
  require(l.stale_after >= ForceLimits::late_factor * l.period,
          "stale_after is less than 1.5 periods: " + number(l.stale_after), "Use ForceLimits::from(device, rate)");
}

PALPATE_INLINE GatedForce ForceGate::apply(const Vector3& wanted, double now, double input_time, bool input_valid,
                                           bool restart) noexcept {
  return apply(wanted, Vector3::Zero(), now, input_time, input_valid, restart);
}

PALPATE_INLINE GatedForce ForceGate::apply(const Vector3& wanted, const Vector3& torque, double now, double input_time,
                                           bool input_valid, bool restart) noexcept {
  Status status;
  const double measured = time_since_last_tick(now);
  const double dt = measured > 0.0 ? measured : limits_.period;
  const double warming = (last_.squaredNorm() - heat_) * std::min(1.0, dt / limits_.heating_time);
  heat_ += measured > 0.0 ? warming : std::max(0.0, warming);
  const double overdue = time_overdue(dt, now, input_time);
  if (dt > ForceLimits::late_factor * limits_.period) status.set(StatusFlag::deadline_missed);

  const bool finite = is_finite(wanted) && is_finite(torque);
  if (!finite) status.set(StatusFlag::non_finite_force);
  if (!input_valid) status.set(StatusFlag::disconnected);
  if (!finite || !input_valid) {
    gain_ = 0.0;
    last_.setZero();
    last_torque_.setZero();
    return {last_, last_torque_, status};
  }
  if (restart) gain_ = 0.0;
  const double step = std::min(dt, limits_.period), most = limits_.slew_rate * step;
  const double gain = update_gain(overdue, step, status);
  last_ = limit_slew(last_, clamp(wanted, allowed_force(), status) * gain, most, status);
  if (limits_.peak_torque > 0.0)
    last_torque_ = limit_slew(last_torque_, clamp(torque, limits_.peak_torque, status) * gain,
                              most * (limits_.peak_torque / limits_.peak_force), status);
  return {last_, last_torque_, status};
}

PALPATE_INLINE void ForceGate::reset() noexcept {
  last_.setZero();
  last_torque_.setZero();
  gain_ = age_ = 0.0;
  last_now_ = last_input_ = std::numeric_limits<double>::quiet_NaN();
}

PALPATE_INLINE bool ForceGate::is_finite(const Vector3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

PALPATE_INLINE void ForceGate::require(bool holds, const std::string& what, const char* hint) {
  if (!holds) raise(SetupErrorKind::bad_argument, what, hint);
}

PALPATE_INLINE double ForceGate::time_since_last_tick(double now) noexcept {
  const double dt = now - last_now_;
  if (std::isfinite(now)) last_now_ = now;
  return std::isfinite(dt) ? std::max(0.0, dt) : 0.0;
}

PALPATE_INLINE double ForceGate::time_overdue(double dt, double now, double input_time) noexcept {
  const bool fresh = input_time != last_input_ && input_time <= now + limits_.stale_after;
  age_ = fresh ? std::max(0.0, now - input_time) : age_ + dt;
  if (fresh) last_input_ = input_time;
  return std::min(dt, (fresh ? std::max(age_, dt) : age_) - limits_.stale_after);
}

PALPATE_INLINE double ForceGate::update_gain(double overdue, double step, Status& status) noexcept {
  const double gain = gain_;
  if (!(overdue <= 0.0)) {
    status.set(StatusFlag::stale);
    return gain_ = std::max(0.0, gain - overdue / limits_.fade_time);
  }
  if (gain < 1.0) status.set(StatusFlag::ramping);
  gain_ = std::min(1.0, gain + step / limits_.ramp_time);
  return gain;
}

PALPATE_INLINE double ForceGate::allowed_force() const noexcept {
  const double most = std::min(limits_.continuous_force, limits_.peak_force);
  const double cold = (1.0 - heat_ / (most * most)) / (1.0 - warm);
  return most + (limits_.peak_force - most) * std::clamp(cold, 0.0, 1.0);
}

PALPATE_INLINE Vector3 ForceGate::clamp(const Vector3& wanted, double most, Status& status) noexcept {
  bool shortened = false;
  const Vector3 force = detail::limit_length(wanted, most, shortened);
  if (shortened) status.set(StatusFlag::saturated);
  return force;
}

PALPATE_INLINE Vector3 ForceGate::limit_slew(const Vector3& last, const Vector3& target, double most,
                                             Status& status) noexcept {
  const Vector3 change = target - last;
  const double length = change.norm();
  if (length <= most) return target;
  status.set(StatusFlag::slew_limited);
  return last + change * (most / length);
}

}}  // namespace palpate
