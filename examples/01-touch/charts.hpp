// The four charts of the report.
#pragma once

#include <palpate/device/recorder.hpp>
#include "chart.hpp"
#include "pictures.hpp"

namespace touch {

struct Charts {
  std::string force, depth, curve, latency, latency_note;
};

/// About every tenth point: still more than a screen can show.
inline std::vector<Vector2> thinned(const std::vector<Vector2>& all, std::size_t from, std::size_t to) {
  const std::size_t step = std::max<std::size_t>(1, (to - from) / 800);
  std::vector<Vector2> few;
  for (std::size_t i = from; i < to; i += step) few.push_back(all[i]);
  return few;
}

/// Counts per bin, eight bins per decade from 1 us to 10 ms; shorter and longer durations go into the first and the
/// last bin.
inline std::string latency_chart(const LoopReport& loop) {
  constexpr int per_decade = 8, bins = 4 * per_decade;
  std::array<double, bins> compute{}, late{};
  for (int bin = 0; bin < DurationHistogram::bins; ++bin) {
    const double us = 0.5e6 * (DurationHistogram::low(bin) + DurationHistogram::low(bin + 1));
    const auto k = static_cast<std::size_t>(std::clamp(per_decade * std::log10(us), 0.0, bins - 1.0));
    compute[k] += static_cast<double>(loop.compute.count(bin));
    late[k] += static_cast<double>(loop.lateness.count(bin));
  }
  const double most = std::max(std::ranges::max(compute), std::ranges::max(late));
  Chart chart("Histogram of tick durations", {"duration [µs]", 1.0, 1e4, true},
              {"ticks", 0.5, std::max(10.0, 2.0 * most), true});
  const auto edge = [](double k) { return std::pow(10.0, k / per_decade); };
  for (std::size_t k = 0; k < bins; ++k) {
    const double from = edge(static_cast<double>(k)), middle = edge(static_cast<double>(k) + 0.5),
                 to = edge(static_cast<double>(k) + 1.0);
    if (compute[k] > 0.0) chart.bar(from, middle, compute[k], "bar");
    if (late[k] > 0.0) chart.bar(middle, to, late[k], "bar grey");
  }
  chart.mark(1e6 / loop.rate, "one period");
  return chart.svg();
}

/// Where the force is, by its estimated error: bands of consecutive ticks whose error was measured.
inline void add_error_bands(Chart& chart, const std::vector<RecordedTick>& ticks, double top) {
  const std::size_t step = std::max<std::size_t>(1, ticks.size() / 800);
  std::vector<Vector2> low, high;
  const auto finish = [&] {
    if (low.size() > 1) chart.band(low, high, "blue");
    low.clear();
    high.clear();
  };
  for (std::size_t i = 0; i < ticks.size(); i += step) {
    const double force = ticks[i].force.norm(), bound = ticks[i].error_bound;
    if (!(force > 0.0 && bound < infinity)) {
      finish();
      continue;
    }
    low.push_back({ticks[i].state.time, std::max(0.0, force - bound)});
    high.push_back({ticks[i].state.time, std::min(top, force + bound)});
  }
  finish();
}

inline Charts make_charts(const Organ& organ, const Recording& session, const Plan& plan) {
  std::vector<Vector2> force, depth, curve;
  double upper = 0.0, deepest = 0.0;
  for (const RecordedTick& tick : session.ticks) {
    const double f = tick.force.norm(), d = 1e3 * penetration(organ, tick.state.position);
    force.push_back({tick.state.time, f});
    depth.push_back({tick.state.time, d});
    curve.push_back({d, f});
    upper = std::max(upper, tick.error_bound < f ? f + tick.error_bound : f);
    deepest = std::max(deepest, d);
  }
  const auto tick_at = [&](double share) {
    const auto it = std::ranges::lower_bound(session.ticks, share * plan.seconds, {},
                                             [](const RecordedTick& t) { return t.state.time; });
    return static_cast<std::size_t>(it - session.ticks.begin());
  };
  const auto first_in = [&](std::size_t from) {
    while (from < curve.size() && curve[from][0] < -1.0) ++from;
    return from;
  };
  const auto first_out = [&](std::size_t from) {
    while (from < curve.size() && curve[from][0] > -1.0) ++from;
    return from;
  };

  const Axis time{"time [s]", 0.0, plan.seconds}, newton = from_zero("force [N]", upper);
  Chart of_force("Force over time", time, newton),
      of_depth("Penetration over time", time, {"penetration [mm]", -15.0, 10.0});
  add_error_bands(of_force, session.ticks, newton.high);
  of_force.line(thinned(force, 0, force.size()), "blue");
  of_depth.line(thinned(depth, 0, depth.size()), "grey");
  of_force.cursor("now");
  of_depth.cursor("now");
  Axis millimetres = from_zero("penetration of the hand into the surface at rest [mm]", deepest);
  millimetres.low = -1.0;
  Chart of_curve("Force over penetration", millimetres, newton);
  const std::size_t pressed = tick_at(0.30), dragged = tick_at(0.72);
  of_curve.line(thinned(curve, pressed, dragged), "grey");
  of_curve.line(thinned(curve, first_in(0), pressed), "blue");
  of_curve.line(thinned(curve, dragged, first_out(dragged)), "rose");
  of_curve.cursor("here");

  std::string note = "<span class='key blue'></span>computing the force";
  if (session.loop.paced) note += "<span class='key grey'></span>waking up too late (the operating system)";
  return {of_force.svg(), of_depth.svg(), of_curve.svg(), latency_chart(session.loop), note};
}

}  // namespace touch
