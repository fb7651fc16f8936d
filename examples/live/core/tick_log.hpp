// What the window knows about the ticks of a tool: the last seconds, counts, and a recording.
#pragma once

#include <palpate/haptic/duration_histogram.hpp>

#include "any_device.hpp"

#include <vector>

namespace live {

/// A tick in the chart.
struct ChartPoint {
  double time = 0.0;   ///< [s] since the first tick
  float force = 0.0F;  ///< [N] rendered
  float bound = 0.0F;  ///< [N] of its error; infinite: not measured
  Status status;
};

class TickLog {
 public:
  static constexpr double window = 5.0;  ///< [s] of the chart

  /// Fetches all ticks since the last call.
  void fetch(Tap& tap);
  /// Begins again, for another composition; a recording continues.
  void clear();

  /// The last seconds, oldest first, some two hundred a second.
  const std::vector<ChartPoint>& chart() const noexcept { return chart_; }
  const DurationHistogram& compute() const noexcept { return compute_; }
  /// Periods without a tick, as the window sees them: reads that came later than 1.5 periods.
  std::uint64_t late() const noexcept { return late_; }
  std::uint64_t ticks() const noexcept { return ticks_; }
  const TickSample& newest() const noexcept { return newest_; }
  /// All flags of the last tenth of a second.
  Status recent() const noexcept { return recent_ | before_; }

  void record(bool on);
  bool recording() const noexcept { return recording_; }
  const std::vector<RecordedTick>& recorded() const noexcept { return recorded_; }

 private:
  void add(const TickSample& sample);

  std::vector<ChartPoint> chart_;
  DurationHistogram compute_;
  TickSample newest_;
  std::uint64_t ticks_ = 0, late_ = 0;
  double first_time_ = 0.0;
  ChartPoint part_;
  Status recent_, before_;
  std::vector<RecordedTick> recorded_;
  bool recording_ = false;
};

}  // namespace live
