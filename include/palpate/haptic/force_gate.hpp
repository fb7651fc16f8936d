// The safety gate: the last thing between a computed force and the device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/limit_length.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

/// What the gate lets through; ForceGate's constructor says how the values must fit together.
struct ForceLimits {
  double peak_force = 3.3;        ///< [N] longest force vector
  double slew_rate = 1650.0;      ///< [N/s] fastest change of the force vector: half the peak per millisecond
  double ramp_time = 0.033;       ///< [s] from zero to full force after start, reacquire, reconnect
  double stale_after = 0.003;     ///< [s] without fresh input until the force begins to fade
  double fade_time = 0.020;       ///< [s] from full force to zero while the input is stale
  double period = 0.001;          ///< [s] nominal tick; one later than 1.5 periods counts as missed
  double peak_torque = 0.0;       ///< [N m] longest torque vector; 0: a device without motors for it
  double continuous_force = 1e9;  ///< [N] what motors stand for ever, as root mean square over heating_time
  double heating_time = 60.0;     ///< [s] time constant of that

  /// The defaults scaled to a device's limits and the rate of its loop [1/s].
  static ForceLimits from(const DeviceLimits& device, double rate = 1000.0) {
    ForceLimits limits;
    limits.peak_force = device.peak_force;
    limits.slew_rate = 500.0 * device.peak_force;
    limits.period = 1.0 / rate;
    limits.stale_after = std::max(limits.stale_after, 3.0 * limits.period);
    limits.peak_torque = device.peak_torque;
    limits.continuous_force = device.continuous_force;
    return limits;
  }
};

/// Makes any computed force safe to render: whatever comes in (NaN, infinity, 1e308, clocks that stop or run back),
/// what goes out is finite and no longer than `peak_force`, and `peak_torque`. Per tick, in this order:
///  1. A force or torque that is not finite, or invalid input: zero at once, and the ramp starts anew. Nothing is known
///     that could justify even the old force for one tick more, so this zeroing alone ignores the slew limit.
///  2. Longer than the peak: shortened to it, direction kept. From 3/4 of the heat of the continuous force on, the peak
///     falls, down to the continuous force when all of it is there. Only time that the clock tells cools.
///  3. Multiplied by a gain in [0, 1]: zero on start and restart, rising over `ramp_time`; falling over `fade_time`
///     while fresh input, or the tick itself, is later than `stale_after`. The clamp comes first: after the gain, a
///     huge force would stay at the peak throughout ramp and fade.
///  4. The change since the last tick is limited to slew_rate * min(time since then, period): a stall buys no jump. A
///     torque may change in the same time as a force: slew_rate * peak_torque / peak_force.
/// Cost: about 0.1 us; no allocation, no throw.
class ForceGate {
 public:
  /// Throws SetupError(bad_argument) unless every limit is between 1e-9 and 1e9, the slew limit lets the fade happen
  /// (slew_rate * fade_time >= peak_force), and a tick in time is not stale (stale_after >= 1.5 * period). The peak
  /// torque may be zero.
  explicit ForceGate(const ForceLimits& limits = {}) : limits_(limits) {
    const ForceLimits& l = limits;
    for (double value : {l.peak_force, l.slew_rate, l.ramp_time, l.stale_after, l.fade_time, l.period,
                         l.continuous_force, l.heating_time, l.peak_torque == 0.0 ? l.period : l.peak_torque})
      require(value >= 1e-9 && value <= 1e9, "a force limit is " + number(value), "Give 1e-9 to 1e9, in SI units");
    require(l.slew_rate * l.fade_time >= l.peak_force * (1.0 - 1e-9),
            "slew_rate * fade_time is less than peak_force, " + number(l.peak_force) + " N", "Raise one of the two");
    require(l.stale_after >= late_factor * l.period, "stale_after is less than 1.5 periods: " + number(l.stale_after),
            "Use ForceLimits::from(device, rate)");
  }

  /// The force to render instead of `wanted` [N]. `now` and `input_time` [s] are of one clock; a caller without a clock
  /// of its own passes input_time twice: input that repeats its stamp still goes stale. `input_valid` is false when the
  /// device could not be read or its pose is not finite; `restart` is true when contact starts anew (tool jumped).
  ToolForce apply(const Vector3& wanted, double now, double input_time, bool input_valid, bool restart) noexcept {
    return apply(wanted, Vector3::Zero(), now, input_time, input_valid, restart);
  }
  /// The same with a torque [N m] about the tool's position.
  ToolForce apply(const Vector3& wanted, const Vector3& torque, double now, double input_time, bool input_valid,
                  bool restart) noexcept {
    ToolForce out;
    const double told = time_since_last_tick(now);
    const double dt = told > 0.0 ? told : limits_.period;
    const double warming = (last_.squaredNorm() - heat_) * std::min(1.0, dt / limits_.heating_time);
    heat_ += told > 0.0 ? warming : std::max(0.0, warming);
    const double overdue = time_overdue(dt, now, input_time);
    if (dt > late_factor * limits_.period) out.status.set(StatusFlag::deadline_missed);

    const bool finite = is_finite(wanted) && is_finite(torque);
    if (!finite) out.status.set(StatusFlag::non_finite_force);
    if (!input_valid) out.status.set(StatusFlag::disconnected);
    if (!finite || !input_valid) {
      gain_ = 0.0;
      last_.setZero();
      last_torque_.setZero();
      return out;
    }
    if (restart) gain_ = 0.0;
    const double step = std::min(dt, limits_.period), most = limits_.slew_rate * step;
    const double gain = update_gain(overdue, step, out.status);
    last_ = out.force = limit_slew(last_, clamp(wanted, allowed_force(), out.status) * gain, most, out.status);
    if (limits_.peak_torque > 0.0)
      last_torque_ = out.torque = limit_slew(last_torque_, clamp(torque, limits_.peak_torque, out.status) * gain,
                                             most * (limits_.peak_torque / limits_.peak_force), out.status);
    return out;
  }

  /// Back to the state after construction, but for the heat of the motors: the next force is zero, at once.
  void reset() noexcept {
    last_.setZero();
    last_torque_.setZero();
    gain_ = age_ = 0.0;
    last_now_ = last_input_ = std::numeric_limits<double>::quiet_NaN();
  }
  const ForceLimits& limits() const noexcept { return limits_; }
  const Vector3& last_force() const noexcept { return last_; }          ///< [N] what the last tick let through
  const Vector3& last_torque() const noexcept { return last_torque_; }  ///< [N m] the same

 private:
  static constexpr double late_factor = 1.5;
  static constexpr double warm = 0.75;  // of the heat of the continuous force, from where the peak falls
  static bool is_finite(const Vector3& v) noexcept {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
  }
  static void require(bool holds, const std::string& what, const char* hint) {
    if (!holds) raise(SetupErrorKind::bad_argument, what, hint);
  }

  /// Zero when a clock does not tell: it stands still, runs backwards or is no number. That counts as one period, but
  /// for cooling: where the clock goes on later, the whole gap will.
  double time_since_last_tick(double now) noexcept {
    const double dt = now - last_now_;
    if (std::isfinite(now)) last_now_ = now;
    return std::isfinite(dt) ? std::max(0.0, dt) : 0.0;
  }

  /// The part of dt that is later than `stale_after` after the newest fresh input or, in a stall, after the last tick;
  /// <= 0 when all is well. Fresh is a stamp that changed and is not from the future; NaN is neither.
  double time_overdue(double dt, double now, double input_time) noexcept {
    const bool fresh = input_time != last_input_ && input_time <= now + limits_.stale_after;
    age_ = fresh ? std::max(0.0, now - input_time) : age_ + dt;
    if (fresh) last_input_ = input_time;
    return std::min(dt, (fresh ? std::max(age_, dt) : age_) - limits_.stale_after);
  }

  double update_gain(double overdue, double step, Status& status) noexcept {
    const double gain = gain_;
    if (!(overdue <= 0.0)) {
      status.set(StatusFlag::stale);
      return gain_ = std::max(0.0, gain - overdue / limits_.fade_time);
    }
    if (gain < 1.0) status.set(StatusFlag::ramping);
    gain_ = std::min(1.0, gain + step / limits_.ramp_time);
    return gain;
  }

  /// What motors this hot may render [N].
  double allowed_force() const noexcept {
    const double most = std::min(limits_.continuous_force, limits_.peak_force);
    const double cold = (1.0 - heat_ / (most * most)) / (1.0 - warm);
    return most + (limits_.peak_force - most) * std::clamp(cold, 0.0, 1.0);
  }

  static Vector3 clamp(const Vector3& wanted, double most, Status& status) noexcept {
    bool shortened = false;
    const Vector3 force = limit_length(wanted, most, shortened);
    if (shortened) status.set(StatusFlag::saturated);
    return force;
  }

  static Vector3 limit_slew(const Vector3& last, const Vector3& target, double most, Status& status) noexcept {
    const Vector3 change = target - last;
    const double length = change.norm();
    if (length <= most) return target;
    status.set(StatusFlag::slew_limited);
    return last + change * (most / length);
  }

  ForceLimits limits_;
  Vector3 last_ = Vector3::Zero(), last_torque_ = Vector3::Zero();
  double heat_ = 0.0;  ///< [N^2] mean square of the force rendered
  double gain_ = 0.0;  ///< what step 3 multiplies with
  double age_ = 0.0;   ///< [s] of the newest input
  double last_now_ = std::numeric_limits<double>::quiet_NaN();
  double last_input_ = std::numeric_limits<double>::quiet_NaN();
};

}}  // namespace palpate
