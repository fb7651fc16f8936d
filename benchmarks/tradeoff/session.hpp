// Runs a contender in simulated time.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/haptic_loop.hpp>

#include <algorithm>

#include "../common/timing.hpp"
#include "contender.hpp"

namespace tradeoff {

inline constexpr double period = 1e-3;  ///< of ticks [s]

/// A device with a rate of 1 kHz in simulated time. During a tick longer than a millisecond the device renders the last
/// force. Updates are published when a background thread would have completed them.
class Session {
 public:
  Session(const Bench& bench, Contender& contender)
      : bench_(bench), contender_(contender), clock_cost_(palpate::detail::measured_clock_cost()) {
    force_.assign(bench.scene.spheres.size(), Vector3::Zero());
  }

  std::vector<double> ticks, updates;  ///< durations, in motion only [s]
  double squared_error = 0.0;          ///< sum over all milliseconds of motion [N^2]
  int samples = 0;
  bool finite = true;
  int barred = 0, contained = 0;  ///< forces with an error bar in motion; those whose bar contains the reference
  std::vector<double> bars;       ///< bounds of the error relative to the force, of the former

  const std::vector<Vector3>& force() const noexcept { return force_; }

  /// Advances the device by a millisecond with the spheres at a depth.
  void advance(double depth, bool record) {
    const double period_of_update = contender_.update_period();
    if (period_of_update > 0.0 && time_ >= next_update_) {
      const double spent = timed([&] { contender_.update(); });
      if (record) updates.push_back(spent);
      // An update published now stands for one that began one duration earlier and is complete now.
      next_update_ = std::max(next_update_ + period_of_update, time_ + spent);
    }
    if (time_ >= next_tick_) {
      const std::vector<Vector3> centres = bench_.scene.centres(depth);
      std::span<const Vector3> answer;
      const double spent = timed([&] { answer = contender_.tick(centres); });
      if (record) ticks.push_back(spent);
      next_tick_ = record ? time_ + spent : time_;  // in holds the duration is ignored
      pending_.assign(answer.begin(), answer.end());
      for (const Vector3& f : pending_) finite = finite && f.allFinite();
      if (record) compare_bars(depth);
    }
    if (!pending_.empty() && next_tick_ <= time_ + period) {  // completed within this millisecond
      force_ = pending_;
      pending_.clear();
    }
    if (record) {
      for (std::size_t b = 0; b < force_.size(); ++b)
        squared_error += (force_[b] - bench_.reference.force(b, depth)).squaredNorm();
      samples += static_cast<int>(force_.size());
    }
    time_ += period;
  }
  enum class Rest { reached, moving, lost };
  /// Holds until the force is constant for two windows, at most `most` milliseconds and `seconds` of processor time.
  /// Tissue without contact counts as moving, and as lost after ten windows.
  Rest settle(double depth, int most, double seconds) {
    const double start = bench::process_seconds();
    std::vector<Vector3> before = force_;
    int still = 0, away = 0;
    for (int i = 1; i <= most && bench::process_seconds() - start < seconds; ++i) {
      // Does not wait for slow updates and ticks: each counts as its nominal period.
      next_tick_ = std::min(next_tick_, time_);
      const double u = contender_.update_period();
      next_update_ = std::min(next_update_, time_ + (u > 0.0 ? u : period));
      advance(depth, false);
      if (i % window() != 0) continue;
      double change = 0.0, size = 0.0;
      for (std::size_t b = 0; b < force_.size(); ++b) {
        change = std::max(change, (force_[b] - before[b]).norm());
        size = std::max(size, force_[b].norm());
      }
      before = force_;
      still = size > 0.0 && change <= 2e-4 * size ? still + 1 : 0;
      away = size > 0.0 ? 0 : away + 1;
      if (still == 2) return Rest::reached;
      if (away == 10) return Rest::lost;
    }
    return Rest::moving;
  }

 private:
  /// Compares the error bars of the last tick with the reference, where that is computed: not at very small depths.
  void compare_bars(double depth) {
    if (depth < 0.5 * bench_.scene.small) return;
    for (std::size_t b = 0; b < pending_.size(); ++b) {
      const double bound = contender_.force_error_bound(b), force = pending_[b].norm();
      if (!(bound < infinity) || !(force > 0.0)) continue;
      ++barred;
      contained += (pending_[b] - bench_.reference.force(b, depth)).norm() <= bound ? 1 : 0;
      bars.push_back(bound / force);
    }
  }
  /// Number of milliseconds over which a force at rest must be constant.
  int window() const noexcept {
    const double three_updates = 3.0 * contender_.update_period() / period;
    return std::max(contender_.has_inertia() ? 40 : 4, static_cast<int>(std::ceil(three_updates)));
  }
  template <class Work>
  double timed(Work&& work) const {
    const std::int64_t start = platform::compute_ns();
    work();
    return std::max(0.0, 1e-9 * static_cast<double>(platform::compute_ns() - start) - clock_cost_);
  }

  const Bench& bench_;
  Contender& contender_;
  double clock_cost_;
  double time_ = 0.0, next_tick_ = 0.0, next_update_ = 0.0;
  std::vector<Vector3> force_, pending_;
};

}  // namespace tradeoff
