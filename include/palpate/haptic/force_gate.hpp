// The safety gate: the last stage between a computed force and the device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// Limits of the gate; ForceGate's constructor documents the conditions between the values.
struct ForceLimits {
  double peak_force = 3.3;        ///< [N] longest force vector
  double slew_rate = 1650.0;      ///< [N/s] fastest change of the force vector: half the peak per millisecond
  double ramp_time = 0.033;       ///< [s] from zero to full force after start, reacquire, reconnect
  double stale_after = 0.003;     ///< [s] without fresh input until the force begins to fade
  double fade_time = 0.020;       ///< [s] from full force to zero while the input is stale
  double period = 0.001;          ///< [s] nominal tick; one later than 1.5 periods counts as missed
  double peak_torque = 0.0;       ///< [N m] longest torque vector; 0: a device without motors for it
  double continuous_force = 1e9;  ///< [N] what motors sustain indefinitely, as root mean square over heating_time
  double heating_time = 60.0;     ///< [s] time constant of the mean square

  static constexpr double late_factor = 1.5;  ///< a tick later than this many periods counts as missed

  /// Punctual ticks of a loop of this rate [1/s] or slower are late.
  double slowest_rate() const noexcept { return 1.0 / (late_factor * period); }
  /// The defaults scaled to a device's limits and its nominal rate.
  static ForceLimits from(const DeviceLimits& device) { return from(device, device.rate); }
  /// The same for a loop of another rate [1/s].
  static ForceLimits from(const DeviceLimits& device, double rate);
};

/// Makes any computed force safe to render: for any input (NaN, infinity, 1e308, clocks that stop or run backwards) the
/// output is finite and no longer than `peak_force` and `peak_torque`. Per tick, in this order:
///  1. A force or torque that is not finite, or invalid input: zero immediately, and the ramp restarts. There is then
///  no
///     valid force, and even the last one may not be kept for a tick, so only this zeroing ignores the slew limit.
///  2. Longer than the peak: shortened to it, direction kept. From 3/4 of the mean square of the continuous force on,
///     the peak decreases, down to the continuous force at its full mean square. Only measured time cools the motors.
///  3. Multiplied by a gain in [0, 1]: zero on start and restart, rising over `ramp_time`; falling over `fade_time`
///     while fresh input, or the tick itself, is later than `stale_after`. The clamp comes first: after the gain, a
///     huge force would stay at the peak throughout ramp and fade.
///  4. The change since the last tick is limited to slew_rate * min(time since then, period), so that a stall allows no
///     jump. A torque may change in the same time as a force: slew_rate * peak_torque / peak_force.
/// Cost: about 0.1 us; no allocation, no throw.
class ForceGate {
 public:
  /// Throws SetupError(bad_argument) unless every limit is between 1e-9 and 1e9, the slew limit allows the fade
  /// (slew_rate * fade_time >= peak_force), and a punctual tick is not stale (stale_after >= 1.5 * period). The peak
  /// torque may be zero.
  explicit ForceGate(const ForceLimits& limits = {});

  /// The force to render instead of `wanted` [N]. `now` and `input_time` [s] are times of the same clock; a caller
  /// without its own clock passes input_time twice: input with a repeated stamp still becomes stale. `input_valid` is
  /// false when the device could not be read or its pose is not finite; `restart` is true when contact restarts (tool
  /// jumped).
  GatedForce apply(const Vector3& wanted, double now, double input_time, bool input_valid, bool restart) noexcept;
  /// The same with a torque [N m] about the tool's position.
  GatedForce apply(const Vector3& wanted, const Vector3& torque, double now, double input_time, bool input_valid,
                   bool restart) noexcept;

  /// Back to the state after construction, except the heat of the motors: the next force is zero, immediately.
  void reset() noexcept;
  const ForceLimits& limits() const noexcept { return limits_; }
  const Vector3& last_force() const noexcept { return last_; }          ///< [N] output of the last tick
  const Vector3& last_torque() const noexcept { return last_torque_; }  ///< [N m] the same

 private:
  static constexpr double warm = 0.75;  // fraction of the continuous mean square above which the peak decreases
  static bool is_finite(const Vector3& v) noexcept;
  static void require(bool holds, const std::string& what, const char* hint);

  /// Zero when the clock gives no duration: it stands still, runs backwards or is not finite. That counts as one
  /// period, except for cooling: when the clock continues later, the whole gap counts.
  double time_since_last_tick(double now) noexcept;

  /// The part of dt that is later than `stale_after` after the newest fresh input or, in a stall, after the last tick;
  /// <= 0 if neither is late. Fresh is a stamp that changed and is not in the future; NaN is not fresh.
  double time_overdue(double dt, double now, double input_time) noexcept;

  double update_gain(double overdue, double step, Status& status) noexcept;

  /// Largest force for the present heat of the motors [N].
  double allowed_force() const noexcept;

  static Vector3 clamp(const Vector3& wanted, double most, Status& status) noexcept;

  static Vector3 limit_slew(const Vector3& last, const Vector3& target, double most, Status& status) noexcept;

  ForceLimits limits_;
  Vector3 last_ = Vector3::Zero(), last_torque_ = Vector3::Zero();
  double heat_ = 0.0;  ///< [N^2] mean square of the force rendered
  double gain_ = 0.0;  ///< factor of step 3
  double age_ = 0.0;   ///< [s] of the newest input
  double last_now_ = std::numeric_limits<double>::quiet_NaN();
  double last_input_ = std::numeric_limits<double>::quiet_NaN();
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/force_gate.ipp>
#endif
