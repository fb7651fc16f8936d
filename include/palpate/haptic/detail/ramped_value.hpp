// A parameter that changes while a haptic loop runs.
#pragma once

#include <palpate/core/config.hpp>

#include <atomic>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Set by any thread, followed by the one that ticks in steps of equal ratio, or of equal size from and to zero, so
/// that the force does not jump. Never waits.
class RampedValue {
 public:
  explicit RampedValue(double value) noexcept : wanted_(value), goal_(value), now_(value) {}
  RampedValue(RampedValue&& other) noexcept : RampedValue(other.wanted()) {}

  // Any thread
  void set(double value) noexcept { wanted_.store(value, std::memory_order_relaxed); }
  double wanted() const noexcept { return wanted_.load(std::memory_order_relaxed); }

  // The thread that ticks
  /// The value in the next tick; the one that was set after `ticks` of them.
  double next(int ticks) noexcept {
    if (const double value = wanted(); value != goal_) {
      goal_ = value;
      left_ = ticks;
    }
    if (left_ == 0) return now_;
    const double part = 1.0 / left_--;
    now_ = left_ == 0                  ? goal_
           : now_ > 0.0 && goal_ > 0.0 ? now_ * std::pow(goal_ / now_, part)
                                       : now_ + part * (goal_ - now_);
    return now_;
  }
  /// The next value is the one that was set last.
  void settle() noexcept {
    now_ = goal_ = wanted();
    left_ = 0;
  }

 private:
  std::atomic<double> wanted_;
  double goal_, now_;
  int left_ = 0;  // ticks until `goal_`
};

}}}  // namespace palpate::detail
