// What a haptic loop has to say afterwards.
#pragma once

#include <palpate/core/status.hpp>
#include <palpate/haptic/duration_histogram.hpp>
#include <palpate/haptic/realtime_thread.hpp>

#include <cstdio>
#include <ostream>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

struct LoopReport {
  double rate = 0.0;     ///< [1/s] asked for
  double elapsed = 0.0;  ///< [s] wall time of the loop
  bool paced = true;
  bool cancelled = false;  ///< by the progress callback
  std::uint64_t ticks = 0;
  std::uint64_t missed_deadlines = 0;  ///< periods without a tick: the one before woke or ended too late
  DurationHistogram compute;           ///< servo.tick: processor time of the thread on Linux, wall time elsewhere
  DurationHistogram lateness;          ///< from deadline to wake-up, wall time; empty unless paced
  double clock_cost = 0.0;             ///< [s] median of two clock readings in a row: contained in every compute time
  double peak_force = 0.0;             ///< [N] longest force the servo gave
  StatusCounters status;               ///< of servo and device, one count per flag and tick
  RealtimeGrant real_time;
};

/// A compact table: what was run, percentiles, peak force, status counts, what real time was granted.
inline std::ostream& operator<<(std::ostream& out, const LoopReport& r) {
  std::array<char, 160> line{};
  std::string text;
  const auto print = [&](const char* format, auto... values) {
    std::snprintf(line.data(), line.size(), format, values...);
    text += line.data();
  };
  const auto row = [&](const char* name, const DurationHistogram& h) {
    print("  %-16s %10.2f %10.2f %10.2f %10.2f\n", name, 1e6 * h.percentile(0.5), 1e6 * h.percentile(0.99),
          1e6 * h.percentile(0.999), 1e6 * h.max());
  };
  print("haptic loop: %llu ticks in %.3f s, %s %g Hz%s\n", static_cast<unsigned long long>(r.ticks), r.elapsed,
        r.paced ? "paced at" : "not paced, simulating", r.rate, r.cancelled ? ", cancelled" : "");
  print("  %-16s %10s %10s %10s %10s\n", "[us]", "p50", "p99", "p99.9", "max");
  row("tick compute", r.compute);
  if (r.paced) row("wake-up lateness", r.lateness);
  print("  missed deadlines %llu, peak force %.3f N, clock reading %.2f us\n",
        static_cast<unsigned long long>(r.missed_deadlines), r.peak_force, 1e6 * r.clock_cost);
  text += "  status:";
  const std::size_t before = text.size();
  for (int bit = 0; bit < status_flag_count; ++bit)
    if (r.status.at(bit) > 0) text += ' ' + std::string(status_flag_name(bit)) + ' ' + std::to_string(r.status.at(bit));
  if (text.size() == before) text += " clean";
  text += "\n  real time: ";
  const RealtimeGrant& g = r.real_time;
  text += !g.requested ? "not requested" : g.fifo ? platform::realtime_scheduling : "normal scheduling";
  if (g.memory_locked) text += ", memory locked";
  if (g.cpu >= 0) text += ", on processor " + std::to_string(g.cpu);
  if (!g.refusals.empty()) text += "; refused: " + g.refusals;
  return out << text << '\n';
}

}}  // namespace palpate
