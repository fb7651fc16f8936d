// The present time on the clock of a device's stamps.
#pragma once

#include <palpate/core/config.hpp>

#include <cmath>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Converts the loop's steady clock to the clock of a device's stamps. Stamps that are at first at most `same_within`
/// older than the steady clock are its own, so ages are absolute. Other clocks have an unknown origin: the youngest
/// pose so far counts as new, so that a delay that grows is found and one that is constant from the start is not.
class StampClock {
 public:
  static constexpr double same_within = 1.0;  ///< [s]
  static constexpr double drift = 1e-3;       ///< rate at which another clock may be slow without ageing its poses
  static constexpr double restart = 0.1;      ///< [s] stamps that run backwards farther are those of a restarted clock

  /// Present time on the clock of the stamps [s], for a stamp and a reading of the steady clock taken after it. NaN
  /// before the first finite stamp.
  double now(double stamp, double steady) noexcept {
    if (std::isfinite(stamp)) note(stamp, steady);
    return steady - offset_;
  }

 private:
  void note(double stamp, double steady) noexcept {
    const double offset = steady - stamp;
    const bool starts = !(stamp >= stamp_ - restart);
    if (starts) same_ = offset >= 0.0 && offset < same_within;
    if (same_)
      offset_ = 0.0;
    else
      offset_ = starts ? offset : std::fmin(offset, offset_ + drift * (steady - steady_));
    stamp_ = stamp;
    steady_ = steady;
  }

  double offset_ = std::numeric_limits<double>::quiet_NaN();
  double stamp_ = std::numeric_limits<double>::quiet_NaN(), steady_ = 0.0;
  bool same_ = false;
};

}}}  // namespace palpate::detail
