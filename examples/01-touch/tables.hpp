// The tables of the report.
#pragma once

#include "pictures.hpp"

#include <utility>

namespace touch {

using Fields = std::vector<std::pair<std::string, std::string>>;

/// Rows of two columns.
inline std::string rows(const Fields& facts) {
  std::string out;
  for (const auto& [name, value] : facts) out += "<tr><th>" + name + "<td>" + value;
  return out;
}

inline std::string seconds_text(double s) {
  if (s < 1e-3) return text("%.1f µs", 1e6 * s);
  return s < 1.0 ? text("%.1f ms", 1e3 * s) : text("%.2f s", s);
}

inline std::string scene_table(const Organ& organ, const Plan& plan, const Vector3& size, double lesion_depth) {
  Fields facts{{"organ", text("%.0f x %.0f x %.0f mm, ", 1e3 * size[0], 1e3 * size[1], 1e3 * size[2]) +
                             text("%lld nodes, %lld linear tetrahedra", static_cast<long long>(organ.report().nodes),
                                  static_cast<long long>(organ.report().elements))}};
  for (const auto& [name, m] : materials)
    facts.push_back({name, text("linear elastic, E = %g kPa, ν = %g, ρ = %g kg/m³", 1e-3 * m.youngs_modulus,
                                m.poisson_ratio, m.density)});
  facts.push_back({"depth of the lesion", text("%.0f mm from the patch to its middle", 1e3 * lesion_depth)});
  facts.push_back({"supports", "ligament and underside; no gravity (the mesh is the shape under gravity)"});
  facts.push_back({"tool", text("rigid sphere, radius %g mm, no friction", 1e3 * tool.radius)});
  facts.push_back({"device", text("simulated: up to %g N, coupled by %g N/m", DeviceLimits{}.peak_force,
                                  DeviceLimits{}.stiffness)});
  facts.push_back(
      {"path of the hand", text("%g mm in, %g mm across the lesion, out again", 1e3 * plan.depth, 1e3 * plan.drag)});
  return rows(facts);
}

inline std::string setup_table(const SetupReport& r) {
  const auto count = [](Index i) { return std::to_string(i); };
  const auto megabytes = [](std::size_t bytes) { return text("%.2f MB", 1e-6 * static_cast<double>(bytes)); };
  Fields facts{
      {"free degrees of freedom",
       count(r.free_dofs) + ": " + count(r.kept_dofs) + " kept, " + count(r.condensed_dofs) + " condensed"},
      {"touchable, rendered", count(r.touchable_vertices) + " vertices, " + count(r.rendered_nodes) + " nodes"},
      {"memory", "stiffness " + megabytes(r.stiffness_bytes) + ", solver " + megabytes(r.solver_bytes) +
                     ", compliance " + megabytes(r.compliance_bytes)},
      {"mesh quality", text("worst %.2f, mean %.2f (1: regular)", r.worst_quality, r.mean_quality)},
      {"condition, probe error", text("%.2g, %.1g", r.condition_estimate, r.probe_error)}};
  for (const auto& [stage, seconds] : r.seconds) facts.push_back({"time: " + stage, seconds_text(seconds)});
  facts.push_back({"time: total", seconds_text(r.total_seconds())});
  for (const auto& [flag, remark] : r.remarks) facts.push_back({"note", remark});
  return rows(facts);
}

inline std::string loop_table(const LoopReport& r) {
  std::string out = "<tr><th><th>median<th>99 %<th>99.9 %<th>longest";
  const auto row = [&](const char* name, const DurationHistogram& h) {
    out += std::string("<tr><th>") + name;
    for (const double d : {h.percentile(0.5), h.percentile(0.99), h.percentile(0.999), h.max()})
      out += "<td>" + seconds_text(d);
  };
  row("computing a tick", r.compute);
  if (r.paced) row("waking up late", r.lateness);
  return out;
}

inline std::string error_text(const ForceErrorReport& r) {
  if (r.contact == 0) return "not measured";
  return text("at most %.3f N (%.0f %% of %.2f N); above %.0f %% in %.0f %% of the ticks in contact", r.largest.bound,
              100.0 * r.largest.relative(), r.largest.force, 100.0 * r.allowed, 100.0 * r.share_over());
}

inline std::string loop_facts(const LoopReport& r) {
  const RealtimeGrant& g = r.real_time;
  std::string grant = !g.requested ? "not requested" : g.fifo ? "SCHED_FIFO granted" : "normal scheduling";
  if (g.memory_locked) grant += ", memory locked";
  if (!g.refusals.empty()) grant += "; refused: " + g.refusals;
  return rows({{"ticks", text("%llu in %.2f s", static_cast<unsigned long long>(r.ticks), r.elapsed) +
                             (r.paced ? text(", paced at %g Hz", r.rate)
                                      : text(", as fast as possible; simulated at %g Hz", r.rate))},
               {"missed periods", std::to_string(r.missed_deadlines)},
               {"peak force", text("%.3f N", r.peak_force)},
               {"error of the force", error_text(r.errors)},
               {"real time", grant},
               {"cost of the clock", seconds_text(r.clock_cost) + " in every compute time"}});
}

inline std::string status_table(const LoopReport& r) {
  std::string out = "<tr><th>flag<th>ticks";
  for (int bit = 0; bit < status_flag_count; ++bit)
    out += "<tr><th>" + std::string(status_flag_name(bit)) + "<td>" +
           (r.status.at(bit) > 0 ? std::to_string(r.status.at(bit)) : "0");
  return out;
}

}  // namespace touch
