#include "tick_log.hpp"

#include <algorithm>

namespace live {

void TickLog::fetch(Tap& tap) {
  for (TickSample sample; tap.pop(sample);) add(sample);
  const double from = part_.time - window;
  const auto kept = std::ranges::find_if(chart_, [&](const ChartPoint& p) { return p.time >= from; });
  if (kept - chart_.begin() > 200) chart_.erase(chart_.begin(), kept);  // seldom: the rest is moved
}

void TickLog::clear() {
  compute_ = {};
  ticks_ = late_ = 0;
  recent_ = before_ = {};
  chart_.clear();
}

void TickLog::add(const TickSample& sample) {
  if (ticks_++ == 0) first_time_ = sample.tick.state.time;
  newest_ = sample;
  compute_.record(sample.compute);
  if (sample.period > 1.5e-3) ++late_;
  if (recording_) recorded_.push_back(sample.tick);

  constexpr std::uint64_t together = 5;  // ticks per point of the chart, the largest force of them
  const auto force = static_cast<float>(sample.tick.force.norm());
  part_.status |= sample.tick.status;
  if (force >= part_.force) {
    part_.force = force;
    part_.bound = static_cast<float>(sample.tick.error_bound);
  }
  part_.time = sample.tick.state.time - first_time_;
  recent_ |= sample.tick.status;
  if (ticks_ % 100 == 0) before_ = std::exchange(recent_, {});
  if (ticks_ % together != 0) return;
  chart_.push_back(part_);
  part_ = ChartPoint{part_.time, 0.0F, 0.0F, {}};
}

void TickLog::record(bool on) {
  if (on && !recording_) recorded_.clear();
  recording_ = on;
}

}  // namespace live
