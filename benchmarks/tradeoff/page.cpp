// The table as a file, as a page with pictures, and as a recommendation.
#include "page.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <ostream>

#include "../common/markup.hpp"

namespace tradeoff {

TradeOff trade_off_of(const std::vector<Row>& rows, double Row::*error, bool compositions_only) {
  TradeOff trade;
  for (const Row& row : rows)
    if (is_good(row) && !(compositions_only && row.paste.empty()))
      trade.add(
          {row.name(), row.p99, row.*error, row.setup, std::isfinite(row.bytes) ? std::max(0.0, row.bytes) : 0.0});
  return trade;
}

std::string three_digits(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, value >= 1000.0 ? "%.0f" : "%.3g", value);
  return text;
}

std::string percent(double value) {
  return three_digits(100.0 * value);
}
const char* colour_of(const std::string& family) {
  return family == "condensed"     ? "#1f5fa8"
         : family == "uncondensed" ? "#2a9d8f"
         : family == "moving"      ? "#b5541c"
         : family == "explicit"    ? "#7b3fa0"
                                   : "#777";
}

namespace {

using bench::escaped;

std::string figure(double value, const char* format) {
  if (!std::isfinite(value)) return "";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
double doubt(const Reference& reference, double Row::*error) {
  return error == &Row::force_small ? reference.mesh_error_small : reference.mesh_error_large;
}

void write_table(std::ostream& out, const std::vector<Row>& rows) {
  out << "<table><thead><tr>";
  for (const char* head :
       {"composition", "nodes", "kept dofs", "set-up [ms]", "memory [MB]", "tick p50 [us]", "p99 [us]", "worst [us]",
        "update p99 [ms]", "force small [%]", "large [%]", "in motion [%]", "moved small [%]", "large [%]",
        "volume small [%]", "large [%]", "energy in 0.1 s [%]", "own check", "remark"})
    out << "<th>" << head << "</th>";
  out << "</tr></thead><tbody>\n";
  for (const Row& r : rows) {
    out << "<tr" << (is_good(r) ? "" : " class='bad'") << "><td style='border-left:6px solid " << colour_of(r.family)
        << "'>" << escaped(r.name()) << "</td>";
    for (const std::string& cell :
         {std::to_string(r.nodes), r.kept_dofs > 0 ? std::to_string(r.kept_dofs) : "", three_digits(1e3 * r.setup),
          three_digits(1e-6 * r.bytes), three_digits(1e6 * r.p50), three_digits(1e6 * r.p99),
          three_digits(1e6 * r.worst), r.update_p99 > 0.0 ? three_digits(1e3 * r.update_p99) : "",
          percent(r.force_small), percent(r.force_large), percent(r.in_motion), percent(r.moved_small),
          percent(r.moved_large), percent(r.volume_small), percent(r.volume_large), percent(r.drift),
          figure(r.own_error, "%.1e"),
          escaped(r.verdict + (r.verdict.empty() || r.remark.empty() ? "" : "; ") + r.remark)})
      out << "<td>" << cell << "</td>";
    out << "</tr>\n";
  }
  out << "</tbody></table>\n";
}

}  // namespace

void write_csv(const std::vector<Row>& rows, const std::string& path) {
  std::ofstream out(path);
  out << "family,element,mesh,kinematics,solver,kept,scalar,work,own_core,nodes,kept_dofs,setup_s,peak_bytes,"
      << "tick_p50_s,tick_p99_s,tick_worst_s,update_p99_s,update_period_s,force_error_small,force_error_large,"
      << "motion_error,displacement_error_small,displacement_error_large,volume_error_small,volume_error_large,"
      << "energy_drift,own_error,verdict,remark\n";
  for (const Row& r : rows) {
    for (const std::string* text :
         {&r.family, &r.element, &r.mesh, &r.kinematics, &r.solver, &r.kept, &r.scalar, &r.work})
      out << '"' << *text << "\",";
    out << (r.own_core ? 1 : 0) << ',' << r.nodes << ',' << r.kept_dofs;
    for (const double value :
         {r.setup, r.bytes, r.p50, r.p99, r.worst, r.update_p99, r.update_period, r.force_small, r.force_large,
          r.in_motion, r.moved_small, r.moved_large, r.volume_small, r.volume_large, r.drift, r.own_error})
      out << ',' << figure(value, "%.6g");
    out << ",\"" << r.verdict << "\",\"" << r.remark << "\"\n";
  }
}

std::string advice(const std::vector<Row>& rows, double budget) {
  std::string text;
  for (const auto& [title, error] : measures) {
    const auto best = trade_off_of(rows, error, true).most_accurate_within(budget);
    if (!best) continue;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name() == best->name; });
    text += "// force " + std::string(title) + ": " + percent(best->error) + " % error, p99 " +
            three_digits(1e6 * best->latency) + " us, set-up " + three_digits(1e3 * best->setup_seconds) + " ms" +
            (row->own_core ? ", a separate core" : "") + "\n//   mesh " + row->mesh +
            (row->kept.empty() ? "" : ", touch " + row->kept) + (row->work.empty() ? "" : ", " + row->work) +
            (row->remark.empty() ? "" : "; " + row->remark) + "\n" + row->paste + "\n";
  }
  return text.empty() ? "// no measured composition keeps a budget of " + three_digits(1e6 * budget) + " us\n" : text;
}

void write_picture(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path) {
  std::ofstream out(path);
  write_plot(out, rows, &Row::in_motion, budget, doubt(bench.reference, &Row::in_motion));
}

void write_page(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path) {
  const PressScene& s = bench.scene;
  const Reference& r = bench.reference;
  std::ofstream out(path);
  out << "<!doctype html><html lang='en'><meta charset='utf-8'><title>Speed against accuracy: " << s.name
      << "</title>\n"
      << "<style>body{font:14px/1.45 sans-serif;max-width:1200px;margin:2em auto;padding:0 1em;color:#222}"
         "figure{margin:1.5em 0}figcaption{font-weight:600}table{border-collapse:collapse;font-size:12px}"
         "th,td{border-bottom:1px solid #ddd;padding:3px 6px;text-align:right}td:first-child,th:first-child,"
         "td:last-child{text-align:left}tr.bad{background:#fee}pre{background:#f4f4f4;padding:1em;overflow:auto}"
         "svg{width:100%;height:auto}</style>\n<h1>Speed against accuracy: "
      << s.name << "</h1>\n<p>" << s.spheres.size() << " sphere" << (s.spheres.size() > 1 ? "s" : "") << " of "
      << three_digits(2e3 * s.radius) << " mm, pressed in " << three_digits(1e3 * s.small) << " and "
      << three_digits(1e3 * s.large) << " mm and then in an oscillation. Reference: neo-Hookean, quadratic tetrahedra, "
      << r.nodes << " nodes, " << figure(r.force(0, s.small).norm(), "%.4g") << " and "
      << figure(r.force(0, s.large).norm(), "%.4g") << " N; the mesh with edges twice as long is "
      << percent(r.mesh_error_small) << " and " << percent(r.mesh_error_large)
      << " % in error. Point at a mark for the whole composition; squares are baselines, marks with a red rim failed "
         "their own check, the line is the Pareto front.</p>\n";
  for (const auto& [family, what] : {std::pair{"condensed", "linear, condensed"},
                                     {"uncondensed", "linear, not condensed"},
                                     {"moving", "moving tissue under a servo"},
                                     {"explicit", "explicit steps"},
                                     {"baseline", "baselines"}})
    out << "<span style='color:" << colour_of(family) << "'>&#9632; " << what << "</span>&emsp;";
  for (const auto& [title, error] : measures) {
    out << "<figure><figcaption>Force error, " << title << "</figcaption>\n";
    write_plot(out, rows, error, budget, doubt(r, error));
    out << "</figure>\n";
  }
  out << "<h2>Within " << three_digits(1e6 * budget) << " us</h2><pre>" << escaped(advice(rows, budget)) << "</pre>\n";
  write_table(out, rows);
  out << "<p>Times are processor times of one thread. in motion: root mean square force error at 1 kHz while the "
         "spheres "
         "move, late ticks and updates included, relative to the largest force. moved: displacement error of all nodes "
         "of the given mesh. volume: error relative to the volume displaced by the spheres. energy: gain of a released "
         "body without damping. own check: residual of the method's own equations.</p></html>\n";
}

}  // namespace tradeoff
