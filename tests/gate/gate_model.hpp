// What the force gate must do, said a second time in plain numbers from its documentation.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gate {

struct Limits {
  double peak, slew, ramp, stale, fade, period;
};
enum : std::uint32_t {  // StatusFlag, as published
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
  Force force{};
  std::uint32_t status = 0;
  std::uint32_t unsure = 0;  ///< flags that rounding decides
};

/// Long double throughout the lengths: nothing overflows there.
inline long double length(const Force& f) {
  long double sum = 0;
  for (double x : f) sum += static_cast<long double>(x) * x;
  return std::sqrt(sum);
}
inline bool near_but_not_at(long double a, long double b) {
  return a != b && std::abs(a - b) <= 1e-12L * b;
}

class Model {
 public:
  explicit Model(const Limits& limits) : l_(limits) {}

  Answer apply(const Force& wanted, double now, double stamp, bool valid, bool restart) {
    Answer a;
    double elapsed = now - now_before_;
    if (std::isfinite(now)) now_before_ = now;
    if (!(elapsed > 0.0) || std::isinf(elapsed)) elapsed = l_.period;
    const double overdue = how_late(elapsed, now, stamp);
    if (elapsed > 1.5 * l_.period) a.status |= deadline_missed;

    bool finite = true;
    for (double x : wanted) finite = finite && std::isfinite(x);
    if (!finite) a.status |= non_finite_force;
    if (!valid) a.status |= disconnected;
    if (!finite || !valid) {
      gain_ = 0.0;
      force_ = {};
      return a;
    }
    if (restart) gain_ = 0.0;
    const double step = elapsed < l_.period ? elapsed : l_.period;
    const Force target = scaled(wanted, overdue, step, a);
    approach(target, l_.slew * step, a);
    a.force = force_;
    return a;
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
  Force scaled(const Force& wanted, double overdue, double step, Answer& a) {
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
    const long double size = length(wanted);
    if (size > l_.peak) a.status |= saturated;
    if (near_but_not_at(size, l_.peak)) a.unsure |= saturated;
    const long double factor = size > l_.peak ? l_.peak / size : 1.0L;
    Force f{};
    for (std::size_t i = 0; i < 3; ++i) f[i] = static_cast<double>(wanted[i] * factor) * gain;
    return f;
  }
  void approach(const Force& target, double most, Answer& a) {
    Force change{};
    for (std::size_t i = 0; i < 3; ++i) change[i] = target[i] - force_[i];
    const long double size = length(change);
    if (size > most) a.status |= slew_limited;
    if (near_but_not_at(size, most)) a.unsure |= slew_limited;
    if (size <= most)
      force_ = target;
    else
      for (std::size_t i = 0; i < 3; ++i) force_[i] += static_cast<double>(change[i] * (most / size));
  }

  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Limits l_;
  Force force_{};
  double gain_ = 0.0, age_ = 0.0, now_before_ = nan, stamp_before_ = nan;
};

}  // namespace gate
