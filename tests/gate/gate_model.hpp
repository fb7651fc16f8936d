// A second implementation of the force gate, in plain numbers, written from its documentation.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gate {

struct Limits {
  double peak, slew, ramp, stale, fade, period, torque, continuous, heating;
};
enum : std::uint32_t {  // values of StatusFlag, as documented
  saturated = 1u << 1,
  slew_limited = 1u << 2,
  stale = 1u << 3,
  deadline_missed = 1u << 4,
  disconnected = 1u << 9,
  ramping = 1u << 11,
  non_finite_force = 1u << 12,
};
using Force = std::array<double, 3>;
struct Answer {
  Force force{}, torque{};
  std::uint32_t status = 0;
  std::uint32_t unsure = 0;  ///< flags that depend on rounding
};

/// Lengths are long double: they cannot overflow.
inline long double length(const Force& f) {
  long double sum = 0;
  for (double x : f) sum += static_cast<long double>(x) * x;
  return std::sqrt(sum);
}
/// Whether the length of a vector is computed without rounding: it is parallel to an axis and has few significant bits.
inline bool is_exact(const Force& f) {
  int components = 0;
  for (double x : f) {
    components += x != 0.0;
    if (std::fmod(x, 0x1p-30) != 0.0) return false;
  }
  return components <= 1;
}
/// Whether rounding decides if `f` is longer than `most`: the lengths are equal up to rounding, and a previous step was
/// rounded.
inline bool is_unsure(const Force& f, long double most, bool rounded) {
  return (rounded || !is_exact(f)) && std::abs(length(f) - most) <= 1e-12L * most;
}

class Model {
 public:
  explicit Model(const Limits& limits) : l_(limits) {}

  Answer apply(const Force& wanted, const Force& wanted_torque, double now, double stamp, bool valid, bool restart) {
    Answer a;
    double elapsed = now - now_before_;
    if (std::isfinite(now)) now_before_ = now;
    const bool guessed = !(elapsed > 0.0) || std::isinf(elapsed);
    if (guessed) elapsed = l_.period;
    const double part = elapsed > l_.heating ? 1.0 : elapsed / l_.heating;
    double square = 0.0;
    for (double x : force_) square += x * x;
    if (!guessed || square > heat_) heat_ = heat_ + part * (square - heat_);
    const double overdue = how_late(elapsed, now, stamp);
    if (elapsed > 1.5 * l_.period) a.status |= deadline_missed;

    bool finite = true;
    for (double x : wanted) finite = finite && std::isfinite(x);
    for (double x : wanted_torque) finite = finite && std::isfinite(x);
    if (!finite) a.status |= non_finite_force;
    if (!valid) a.status |= disconnected;
    if (!finite || !valid) {
      gain_ = 0.0;
      force_ = torque_ = {};
      return a;
    }
    if (restart) gain_ = 0.0;
    const double step = elapsed < l_.period ? elapsed : l_.period;
    const double gain = gain_now(overdue, step, a);
    approach(force_, shortened(wanted, peak_now(), gain, a), l_.slew * step, a);
    if (l_.torque != 0.0)
      approach(torque_, shortened(wanted_torque, l_.torque, gain, a), l_.slew * step / l_.peak * l_.torque, a);
    a.force = force_;
    a.torque = torque_;
    return a;
  }
  /// Takes the gate's output: once it differs by rounding, later results may differ too.
  void compare(const Force& force, const Force& torque) { rounded_ = force != force_ || torque != torque_; }
  /// Resets everything but the motor temperature.
  void reset() {
    const double heat = heat_;
    *this = Model(l_);
    heat_ = heat;
  }

 private:
  double how_late(double elapsed, double now, double stamp) {
    double waited = 0.0;
    if (stamp != stamp_before_ && stamp <= now + l_.stale) {
      age_ = now - stamp > 0.0 ? now - stamp : 0.0;
      stamp_before_ = stamp;
      waited = age_ > elapsed ? age_ : elapsed;
    } else {
      waited = age_ += elapsed;
    }
    const double late = waited - l_.stale;
    return late < elapsed ? late : elapsed;
  }
  double peak_now() const {
    const double c = l_.continuous;
    if (c >= l_.peak || heat_ <= 0.75 * c * c) return l_.peak;
    return heat_ >= c * c ? c : c + (l_.peak - c) * 4.0 * (1.0 - heat_ / (c * c));
  }
  double gain_now(double overdue, double step, Answer& a) {
    double gain = gain_;
    if (!(overdue <= 0.0)) {
      a.status |= stale;
      gain_ -= overdue / l_.fade;
      if (gain_ < 0.0) gain_ = 0.0;
      gain = gain_;
    } else {
      if (gain < 1.0) a.status |= ramping;
      gain_ += step / l_.ramp;
      if (gain_ > 1.0) gain_ = 1.0;
    }
    return gain;
  }
  Force shortened(const Force& wanted, double peak, double gain, Answer& a) {
    const long double size = length(wanted);
    if (size > peak) a.status |= saturated;
    if (is_unsure(wanted, peak, heat_ > 0.7 * l_.continuous * l_.continuous)) a.unsure |= saturated;
    const long double factor = size > peak ? peak / size : 1.0L;
    Force f{};
    for (std::size_t i = 0; i < 3; ++i) f[i] = static_cast<double>(wanted[i] * factor) * gain;
    return f;
  }
  void approach(Force& from, const Force& target, double most, Answer& a) {
    Force change{};
    for (std::size_t i = 0; i < 3; ++i) change[i] = target[i] - from[i];
    const long double size = length(change);
    if (size > most) a.status |= slew_limited;
    if (is_unsure(change, most, rounded_)) a.unsure |= slew_limited;
    if (size <= most)
      from = target;
    else
      for (std::size_t i = 0; i < 3; ++i) from[i] += static_cast<double>(change[i] * (most / size));
  }

  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Limits l_;
  Force force_{}, torque_{};
  bool rounded_ = false;
  double heat_ = 0.0, gain_ = 0.0, age_ = 0.0, now_before_ = nan, stamp_before_ = nan;
};

}  // namespace gate
