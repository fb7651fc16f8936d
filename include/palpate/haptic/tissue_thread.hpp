// Moves a tissue on in a thread of its own.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/core/platform.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

/// What a tissue's thread has done.
struct TissueThreadReport {
  std::uint64_t steps = 0;
  std::uint64_t late = 0;      ///< steps that took longer than they last
  double worst_seconds = 0.0;  ///< of one step
  double mean_seconds = 0.0;
  /// Tissue time over wall time: 1 keeps up; below, tools feel a tissue that moves in slow motion. Steady forces stay
  /// right.
  double rate = 0.0;
};

/// Calls `advance()` once per step of wall time from construction to destruction; where a step takes longer, the next
/// one follows at once, and lost time is not made up for. Refers to the tissue, which must outlive it.
template <MovingTissue Tissue>
class TissueThread {
 public:
  explicit TissueThread(Tissue& tissue) : tissue_(&tissue), thread_([this] { run(); }) {}
  ~TissueThread() { stop(); }
  TissueThread(const TissueThread&) = delete;
  TissueThread& operator=(const TissueThread&) = delete;

  /// Ends after the step in work. What it did may be read then.
  void stop() {
    stop_.store(true, std::memory_order_relaxed);
    if (thread_.joinable()) thread_.join();
  }
  /// After stop().
  const TissueThreadReport& report() const noexcept { return report_; }

 private:
  void run() noexcept {
    const auto period = static_cast<std::int64_t>(1e9 * tissue_->step());
    const std::int64_t start = platform::wall_ns();
    std::int64_t next = start;
    double sum = 0.0;
    while (!stop_.load(std::memory_order_relaxed)) {
      const std::int64_t before = platform::wall_ns();
      tissue_->advance();
      const std::int64_t after = platform::wall_ns();
      const double seconds = 1e-9 * static_cast<double>(after - before);
      sum += seconds;
      report_.worst_seconds = std::max(report_.worst_seconds, seconds);
      ++report_.steps;
      if (after - before > period) ++report_.late;
      next = std::max(next + period, after);
      platform::sleep_until_ns(next);
    }
    const double steps = static_cast<double>(report_.steps);
    report_.mean_seconds = report_.steps > 0 ? sum / steps : 0.0;
    report_.rate = steps * tissue_->step() / (1e-9 * static_cast<double>(platform::wall_ns() - start));
  }

  Tissue* tissue_;
  std::atomic<bool> stop_{false};
  TissueThreadReport report_;
  std::thread thread_;  // last: it uses all the others
};

}}  // namespace palpate
