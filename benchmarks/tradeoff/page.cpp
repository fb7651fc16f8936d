// The table as a file, as a page with pictures, and as advice.
#include "page.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>

namespace tradeoff {

TradeOff trade_off_of(const std::vector<Row>& rows, double Row::*error, bool compositions_only) {
  TradeOff trade;
  for (const Row& row : rows)
    if (is_good(row) && !(compositions_only && row.paste.empty()))
      trade.add(
          {row.name(), row.p99, row.*error, row.setup, std::isfinite(row.bytes) ? std::max(0.0, row.bytes) : 0.0});
  return trade;
}

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}
std::string figure(double value, const char* format) {
  if (!std::isfinite(value)) return "";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
std::string percent(double value) {
  return figure(100.0 * value, "%.3g");
}

const char* colour_of(const std::string& family) {
  return family == "condensed"     ? "#1f5fa8"
         : family == "uncondensed" ? "#2a9d8f"
         : family == "moving"      ? "#b5541c"
         : family == "explicit"    ? "#7b3fa0"
                                   : "#777";
}

/// Everything a reader may want to know of a row while the pointer is on it.
std::string hover(const Row& r) {
  return escaped(r.name() + "\nset-up " + figure(1e3 * r.setup, "%.3g") + " ms, " + figure(1e-6 * r.bytes, "%.3g") +
                 " MB\ntick p50 " + figure(1e6 * r.p50, "%.3g") + " us, p99 " + figure(1e6 * r.p99, "%.3g") +
                 " us, worst " + figure(1e6 * r.worst, "%.3g") + " us\nforce off " + percent(r.force_small) +
                 " % (small), " + percent(r.force_large) + " % (large), felt " + percent(r.felt) + " %" +
                 (r.verdict.empty() ? "" : "\n" + r.verdict) + (r.remark.empty() ? "" : "\n" + r.remark));
}

/// What tells the rows of a front apart at a glance.
std::string label(const Row& r) {
  std::string text = r.element;
  if (r.mesh != "as given") text += ", " + r.mesh;
  if (r.kinematics != "linear") text += ", " + r.kinematics;
  if (!r.solver.starts_with("Condensed")) text += ", " + r.solver;
  return text;
}

/// Error over latency, both logarithmic, with the front of what nothing beats.
class Plot {
 public:
  Plot(const std::vector<Row>& rows, double Row::*error) : rows_(rows), error_(error) {
    for (const Row& r : rows) {
      if (!(r.p99 > 0.0) || !std::isfinite(r.p99) || !std::isfinite(r.*error) || !(r.*error > 0.0)) continue;
      low_x_ = std::min(low_x_, std::log10(r.p99));
      high_x_ = std::max(high_x_, std::log10(r.p99));
      low_y_ = std::min(low_y_, std::log10(r.*error));
      high_y_ = std::max(high_y_, std::log10(std::min(r.*error, 10.0)));
    }
    low_x_ = std::floor(low_x_ - 0.1);
    high_x_ = std::ceil(high_x_ + 0.1);
    low_y_ = std::floor(2.0 * low_y_ - 0.1) / 2.0;
    high_y_ = std::ceil(2.0 * high_y_ + 0.1) / 2.0;
  }

  /// As SVG, by itself or in a page.
  void write(std::ostream& out, double budget, double floor) const {
    out << "<svg xmlns='http://www.w3.org/2000/svg' font-family='sans-serif' viewBox='0 0 " << width << ' ' << height
        << "' role='img'>\n<rect width='" << width << "' height='" << height << "' fill='white'/>\n";
    grid(out);
    line(out, x(budget), top, x(budget), bottom, "stroke='#c33' stroke-dasharray='5 4'");
    text(out, x(budget) + 4, top + 12, "budget", "fill='#c33'");
    if (floor > 0.0 && std::log10(floor) > low_y_) {
      line(out, left, y(floor), right, y(floor), "stroke='#999' stroke-dasharray='2 3'");
      text(out, left + 4, y(floor) - 4, "doubt of the reference", "fill='#777'");
    }
    out << "<polyline fill='none' stroke='#222' stroke-width='1.2' points='";
    double last = top;
    const auto front = trade_off_of(rows_, error_, false).front();
    for (const MeasuredComposition& m : front) {
      out << x(m.latency) << ',' << last << ' ' << x(m.latency) << ',' << y(m.error) << ' ';
      last = y(m.error);
    }
    out << right << ',' << last << "'/>\n";
    for (const Row& r : rows_) point(out, r);
    for (const Row& r : rows_)
      if (std::ranges::count(front, r.name(), &MeasuredComposition::name) > 0)
        text(out, x(r.p99) + 7, y(r.*error_) - 7, escaped(label(r)), "fill='#222'");
    out << "</svg>\n";
  }

 private:
  static constexpr double width = 860, height = 460, left = 70, right = 840, top = 15, bottom = 410;

  double x(double seconds) const {
    return left + (right - left) * std::clamp((std::log10(seconds) - low_x_) / (high_x_ - low_x_), 0.0, 1.0);
  }
  double y(double error) const {
    return bottom -
           (bottom - top) * std::clamp((std::log10(std::max(error, 1e-12)) - low_y_) / (high_y_ - low_y_), 0.0, 1.0);
  }
  static void line(std::ostream& out, double x1, double y1, double x2, double y2, const char* style) {
    out << "<line x1='" << x1 << "' y1='" << y1 << "' x2='" << x2 << "' y2='" << y2 << "' " << style << "/>\n";
  }
  static void text(std::ostream& out, double x, double y, const std::string& what, const char* style) {
    out << "<text x='" << x << "' y='" << y << "' font-size='11' " << style << '>' << what << "</text>\n";
  }
  /// 1, 2, 5, 10, ... between two powers of ten.
  static std::vector<double> round_values(double low, double high) {
    std::vector<double> values;
    for (double e = std::floor(low); e <= high; e += 1.0)
      for (const double digit : {1.0, 2.0, 5.0})
        if (const double at = e + std::log10(digit); at > low - 1e-9 && at < high + 1e-9)
          values.push_back(digit * std::pow(10.0, e));
    return values;
  }
  void grid(std::ostream& out) const {
    for (const double at : round_values(low_x_ + 6.0, high_x_ + 6.0)) {
      line(out, x(1e-6 * at), top, x(1e-6 * at), bottom, "stroke='#e4e4e4'");
      const bool crowded = high_x_ - low_x_ > 3.0 && std::abs(std::remainder(std::log10(at), 1.0)) > 1e-9;
      if (!crowded) text(out, x(1e-6 * at), bottom + 16, figure(at, "%g"), "text-anchor='middle' fill='#555'");
    }
    for (const double at : round_values(low_y_ + 2.0, high_y_ + 2.0)) {
      line(out, left, y(1e-2 * at), right, y(1e-2 * at), "stroke='#e4e4e4'");
      text(out, left - 6, y(1e-2 * at) + 4, figure(at, "%g") + " %", "text-anchor='end' fill='#555'");
    }
    text(out, 0.5 * (left + right), bottom + 36, "p99 of a tick [us]", "text-anchor='middle' fill='#333'");
  }
  void point(std::ostream& out, const Row& r) const {
    if (!std::isfinite(r.p99) || !std::isfinite(r.*error_)) return;
    const double cx = x(r.p99), cy = y(r.*error_);
    const std::string look = std::string("fill='") + (is_good(r) ? colour_of(r.family) : "white") + "' stroke='" +
                             (is_good(r) ? "white" : "#c00") + "'";
    if (r.family == "baseline")
      out << "<rect x='" << cx - 5 << "' y='" << cy - 5 << "' width='10' height='10' " << look << '>';
    else
      out << "<circle cx='" << cx << "' cy='" << cy << "' r='6' " << look << '>';
    out << "<title>" << hover(r) << "</title>" << (r.family == "baseline" ? "</rect>\n" : "</circle>\n");
  }

  const std::vector<Row>& rows_;
  double Row::*error_;
  double low_x_ = infinity, high_x_ = -infinity, low_y_ = infinity, high_y_ = -infinity;
};

double doubt(const Reference& reference, double Row::*error) {
  return error == &Row::force_small ? reference.mesh_error_small : reference.mesh_error_large;
}

void write_table(std::ostream& out, const std::vector<Row>& rows) {
  out << "<table><thead><tr>";
  for (const char* head :
       {"composition", "nodes", "kept dofs", "set-up [ms]", "memory [MB]", "tick p50 [us]", "p99 [us]", "worst [us]",
        "update p99 [ms]", "force small [%]", "large [%]", "felt [%]", "moved small [%]", "large [%]",
        "volume small [%]", "large [%]", "energy in 0.1 s [%]", "own check", "remark"})
    out << "<th>" << head << "</th>";
  out << "</tr></thead><tbody>\n";
  for (const Row& r : rows) {
    out << "<tr" << (is_good(r) ? "" : " class='bad'") << "><td style='border-left:6px solid " << colour_of(r.family)
        << "'>" << escaped(r.name()) << "</td>";
    for (const std::string& cell :
         {std::to_string(r.nodes), r.kept_dofs > 0 ? std::to_string(r.kept_dofs) : "", figure(1e3 * r.setup, "%.3g"),
          figure(1e-6 * r.bytes, "%.3g"), figure(1e6 * r.p50, "%.3g"), figure(1e6 * r.p99, "%.3g"),
          figure(1e6 * r.worst, "%.3g"), r.update_p99 > 0.0 ? figure(1e3 * r.update_p99, "%.3g") : "",
          percent(r.force_small), percent(r.force_large), percent(r.felt), percent(r.moved_small),
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
      << "felt_error,displacement_error_small,displacement_error_large,volume_error_small,volume_error_large,"
      << "energy_drift,own_error,verdict,remark\n";
  for (const Row& r : rows) {
    for (const std::string* text :
         {&r.family, &r.element, &r.mesh, &r.kinematics, &r.solver, &r.kept, &r.scalar, &r.work})
      out << '"' << *text << "\",";
    out << (r.own_core ? 1 : 0) << ',' << r.nodes << ',' << r.kept_dofs;
    for (const double value :
         {r.setup, r.bytes, r.p50, r.p99, r.worst, r.update_p99, r.update_period, r.force_small, r.force_large, r.felt,
          r.moved_small, r.moved_large, r.volume_small, r.volume_large, r.drift, r.own_error})
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
    text += "// force " + std::string(title) + ": " + percent(best->error) + " % off, p99 " +
            figure(1e6 * best->latency, "%.3g") + " us, set-up " + figure(1e3 * best->setup_seconds, "%.3g") + " ms" +
            (row->own_core ? ", a core of its own" : "") + "\n//   mesh " + row->mesh +
            (row->kept.empty() ? "" : ", touch " + row->kept) + (row->work.empty() ? "" : ", " + row->work) +
            (row->remark.empty() ? "" : "; " + row->remark) + "\n" + row->paste + "\n";
  }
  return text.empty() ? "// nothing measured keeps a budget of " + figure(1e6 * budget, "%.3g") + " us\n" : text;
}

void write_picture(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path) {
  std::ofstream out(path);
  Plot(rows, &Row::felt).write(out, budget, doubt(bench.reference, &Row::felt));
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
      << s.name << "</h1>\n<p>" << s.balls.size() << " ball" << (s.balls.size() > 1 ? "s" : "") << " of "
      << figure(2e3 * s.radius, "%.3g") << " mm, pressed in " << figure(1e3 * s.small, "%.3g") << " and "
      << figure(1e3 * s.large, "%.3g") << " mm and then to and fro. Reference: neo-Hookean, quadratic tetrahedra, "
      << r.nodes << " nodes, " << figure(r.force(0, s.small).norm(), "%.4g") << " and "
      << figure(r.force(0, s.large).norm(), "%.4g") << " N; the mesh with edges twice as long is "
      << percent(r.mesh_error_small) << " and " << percent(r.mesh_error_large)
      << " % off. Point at a mark for the whole composition; squares are baselines, marks with a red rim failed their "
         "own check, the line joins what nothing beats.</p>\n";
  for (const auto& [family, what] : {std::pair{"condensed", "linear, condensed"},
                                     {"uncondensed", "linear, not condensed"},
                                     {"moving", "moving tissue under a servo"},
                                     {"explicit", "explicit steps"},
                                     {"baseline", "baselines"}})
    out << "<span style='color:" << colour_of(family) << "'>&#9632; " << what << "</span>&emsp;";
  for (const auto& [title, error] : measures) {
    out << "<figure><figcaption>Force error, " << title << "</figcaption>\n";
    Plot(rows, error).write(out, budget, doubt(r, error));
    out << "</figure>\n";
  }
  out << "<h2>Within " << figure(1e6 * budget, "%.3g") << " us</h2><pre>" << escaped(advice(rows, budget))
      << "</pre>\n";
  write_table(out, rows);
  out << "<p>Times are processor times of one thread. felt: root mean square of what the device renders a thousand "
         "times "
         "a second while the balls move, late ticks and updates included, of the largest force. moved: displacement of "
         "all nodes of the mesh as given. volume: of the volume that the balls press in. energy: what a body that is "
         "let go gains without damping. own check: how far the row is from its own formula.</p></html>\n";
}

}  // namespace tradeoff
