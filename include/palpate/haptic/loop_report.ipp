// Definitions of loop_report.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/haptic/loop_report.hpp>

#include <array>
#include <cstdio>
#include <ostream>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

PALPATE_INLINE RealtimeGrant request_realtime(const LoopOptions& options) {
  RealtimeGrant grant;
  grant.requested = options.real_time && options.paced;
  const auto granted = [&](int error, const char* what) {
    if (error != 0) grant.refusals += std::string(what) + ": " + platform::error_text(error) + ". ";
    return error == 0;
  };
  if (options.cpu >= 0 && granted(platform::pin_this_thread(options.cpu), "pinning")) grant.cpu = options.cpu;
  platform::ask_for_exact_sleeps();
  if (!grant.requested) return grant;
  grant.fifo = granted(platform::ask_for_realtime_scheduling(), platform::realtime_scheduling);
  grant.memory_locked = granted(platform::lock_memory(), "locking memory");
  return grant;
}

}  // namespace detail

PALPATE_INLINE void ForceErrorReport::count(const ForceError& error) noexcept {
  if (!(error.force > 0.0)) return;
  if (!(error.bound < infinity)) {
    ++unknown;
    return;
  }
  ++contact;
  if (error.bound > allowed * error.force) ++over;
  if (error.bound > largest.bound) largest = error;
}

PALPATE_INLINE void ForceErrorReport::count(const ForceErrorReport& other) noexcept {
  contact += other.contact;
  over += other.over;
  unknown += other.unknown;
  if (other.largest.bound > largest.bound) largest = other.largest;
}

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const ForceErrorReport& r) {
  if (r.contact == 0)
    return out << (r.unknown > 0 ? "error of the force: not measured" : "error of the force: no contact");
  std::array<char, 200> line{};
  std::snprintf(
      line.data(), line.size(),
      "error of the force: bound above %.0f %% in %.1f %% of %llu ticks in contact; largest %.3g N (%.0f %% of "
      "%.3g N)",
      100.0 * r.allowed, 100.0 * r.share_over(), static_cast<unsigned long long>(r.contact), r.largest.bound,
      100.0 * r.largest.relative(), r.largest.force);
  out << line.data();
  const auto values = r.largest.parts.values();
  const char* before = ": ";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] > 0.01 * r.largest.bound)) continue;
    std::snprintf(line.data(), line.size(), "%s%s %.3g N", before, ForceErrorParts::names[i].data(), values[i]);
    out << line.data();
    before = ", ";
  }
  if (r.unknown > 0) out << "; not measured in " << r.unknown << " ticks";
  return out;
}

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const LoopReport& r) {
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
  out << text;
  if (r.errors.contact > 0) out << "  " << r.errors << '\n';
  out << "  status: " << r.status;
  for (std::size_t i = 0; r.devices.size() > 1 && i < r.devices.size(); ++i) {
    text.clear();
    print("\n  device %d: peak force %.3f N, status: ", static_cast<int>(i), r.devices[i].peak_force);
    out << text << r.devices[i].status;
    if (r.devices[i].errors.contact > 0) out << "\n    " << r.devices[i].errors;
  }
  text = "\n  real time: ";
  const RealtimeGrant& g = r.real_time;
  text += !g.requested ? "not requested" : g.fifo ? platform::realtime_scheduling : "normal scheduling";
  if (g.memory_locked) text += ", memory locked";
  if (g.cpu >= 0) text += ", on processor " + std::to_string(g.cpu);
  if (!g.refusals.empty()) text += "; refused: " + g.refusals;
  out << text << '\n';
  for (const std::string& note : r.notes) out << "  note: " << note << '\n';
  return out;
}

}}  // namespace palpate
