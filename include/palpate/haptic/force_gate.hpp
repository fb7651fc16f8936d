// The safety gate: the last thing between a computed force and the device.
#pragma once

#include <palpate/concepts/haptic_device.hpp>

#include <string>

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

  /// The defaults scaled to a device's limits and the rate it is meant to be served at.
  static ForceLimits from(const DeviceLimits& device) { return from(device, device.rate); }
  /// The same for a loop of another rate [1/s].
  static ForceLimits from(const DeviceLimits& device, double rate);
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
  explicit ForceGate(const ForceLimits& limits = {});

  /// The force to render instead of `wanted` [N]. `now` and `input_time` [s] are of one clock; a caller without a clock
  /// of its own passes input_time twice: input that repeats its stamp still goes stale. `input_valid` is false when the
  /// device could not be read or its pose is not finite; `restart` is true when contact starts anew (tool jumped).
  GatedForce apply(const Vector3& wanted, double now, double input_time, bool input_valid, bool restart) noexcept;
  /// The same with a torque [N m] about the tool's position.
  GatedForce apply(const Vector3& wanted, const Vector3& torque, double now, double input_time, bool input_valid,
                   bool restart) noexcept;

  /// Back to the state after construction, but for the heat of the motors: the next force is zero, at once.
  void reset() noexcept;
  const ForceLimits& limits() const noexcept { return limits_; }
  const Vector3& last_force() const noexcept { return last_; }          ///< [N] what the last tick let through
  const Vector3& last_torque() const noexcept { return last_torque_; }  ///< [N m] the same

 private:
  static constexpr double late_factor = 1.5;
  static constexpr double warm = 0.75;  // of the heat of the continuous force, from where the peak falls
  static bool is_finite(const Vector3& v) noexcept;
  static void require(bool holds, const std::string& what, const char* hint);

  /// Zero when a clock does not tell: it stands still, runs backwards or is no number. That counts as one period, but
  /// for cooling: where the clock goes on later, the whole gap will.
  double time_since_last_tick(double now) noexcept;

  /// The part of dt that is later than `stale_after` after the newest fresh input or, in a stall, after the last tick;
  /// <= 0 when all is well. Fresh is a stamp that changed and is not from the future; NaN is neither.
  double time_overdue(double dt, double now, double input_time) noexcept;

  double update_gain(double overdue, double step, Status& status) noexcept;

  /// What motors this hot may render [N].
  double allowed_force() const noexcept;

  static Vector3 clamp(const Vector3& wanted, double most, Status& status) noexcept;

  static Vector3 limit_slew(const Vector3& last, const Vector3& target, double most, Status& status) noexcept;

  ForceLimits limits_;
  Vector3 last_ = Vector3::Zero(), last_torque_ = Vector3::Zero();
  double heat_ = 0.0;  ///< [N^2] mean square of the force rendered
  double gain_ = 0.0;  ///< what step 3 multiplies with
  double age_ = 0.0;   ///< [s] of the newest input
  double last_now_ = std::numeric_limits<double>::quiet_NaN();
  double last_input_ = std::numeric_limits<double>::quiet_NaN();
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/force_gate.ipp>
#endif
