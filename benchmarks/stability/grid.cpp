#include "grid.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "../common/markup.hpp"

namespace maps {

using bench::escaped;

namespace {

constexpr double side = 15, above = 22, right = 14;

/// Width [px] of the longest of some labels.
double room(const std::vector<std::string>& labels) {
  std::size_t longest = 0;
  for (const std::string& label : labels) longest = std::max(longest, label.size());
  return 8.0 + 6.2 * static_cast<double>(longest);
}
double left_of(const Grid& g) {
  return std::max(room(g.rows), 54.0);  // at least the width of the axis name
}
double below_of(const Grid& g) {
  return 16.0 + room(g.columns);
}

void draw(std::ostream& out, double x, double y, const Square& s) {
  const double a = x + 1, b = y + 1, w = side - 2, c = x + 0.5 * side, d = y + 0.5 * side;
  out << "<g><title>" << escaped(s.tip) << "</title>";
  if (s.verdict == Verdict::refused)
    out << "<rect x='" << a << "' y='" << b << "' width='" << w << "' height='" << w << "' class='refused'/><path d='M"
        << a + 3 << ' ' << b + w - 3 << 'L' << a + w - 3 << ' ' << b + 3 << "' class='slash'/>";
  else
    out << "<rect x='" << a << "' y='" << b << "' width='" << w << "' height='" << w << "' class='"
        << (s.verdict == Verdict::wrong      ? "wrong"
            : s.verdict == Verdict::unjudged ? "unjudged"
                                             : "s" + std::to_string(s.shade))
        << "'/>";
  if (s.verdict == Verdict::flagged)
    out << "<path d='M" << c << ' ' << d - 4 << 'L' << c + 4 << ' ' << d + 3 << 'L' << c - 4 << ' ' << d + 3
        << "Z' class='flag'/>";
  if (s.verdict == Verdict::wrong)
    out << "<path d='M" << c - 4 << ' ' << d - 4 << 'L' << c + 4 << ' ' << d + 4 << 'M' << c - 4 << ' ' << d + 4 << 'L'
        << c + 4 << ' ' << d - 4 << "' class='cross'/>";
  out << "</g>";
}

/// Draws the part of a line inside the panel, one segment at a time.
void draw_line(std::ostream& out, const Grid& g, double x0, double y0) {
  const double columns = static_cast<double>(g.columns.size()), rows = static_cast<double>(g.rows.size());
  for (std::size_t i = 0; i + 1 < g.line.size(); ++i) {
    double from = 0.0, to = 1.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const double p = g.line[i][k], q = g.line[i + 1][k], high = (k == 0 ? columns : rows) - 0.5;
      if (p == q) continue;
      const double s = (-0.5 - p) / (q - p), t = (high - p) / (q - p);
      from = std::max(from, std::min(s, t));
      to = std::min(to, std::max(s, t));
    }
    if (from >= to) continue;
    const auto at = [&](double t) {
      std::ostringstream point;
      point << x0 + side * (g.line[i][0] + t * (g.line[i + 1][0] - g.line[i][0]) + 0.5) << ' '
            << y0 + side * (rows - 0.5 - g.line[i][1] - t * (g.line[i + 1][1] - g.line[i][1]));
      return point.str();
    };
    out << "<path d='M" << at(from) << 'L' << at(to) << "' class='limit'/>";
  }
}

void draw(std::ostream& out, double x, double y, const Grid& g, const std::string& x_name, const std::string& y_name) {
  const double x0 = x + left_of(g), y0 = y + above;
  const double bottom = y0 + side * static_cast<double>(g.rows.size());
  out << "<text x='" << x0 << "' y='" << y0 - 6 << "' class='title'>" << escaped(g.title) << "</text>\n";
  for (std::size_t r = 0; r < g.rows.size(); ++r) {
    const double top = bottom - side * static_cast<double>(r + 1);
    out << "<text x='" << x0 - 4 << "' y='" << top + 11 << "' text-anchor='end'>" << escaped(g.rows[r]) << "</text>";
    for (std::size_t c = 0; c < g.columns.size(); ++c)
      draw(out, x0 + side * static_cast<double>(c), top, g.squares[r * g.columns.size() + c]);
    out << '\n';
  }
  for (std::size_t c = 0; c < g.columns.size(); ++c) {
    const double at = x0 + side * (static_cast<double>(c) + 0.5);
    out << "<text transform='translate(" << at + 3 << ' ' << bottom + 5 << ") rotate(90)'>" << escaped(g.columns[c])
        << "</text>";
  }
  draw_line(out, g, x0, y0);
  out << "<text x='" << x0 + side * static_cast<double>(g.columns.size()) << "' y='" << bottom + below_of(g) - 10
      << "' text-anchor='end' class='axis'>" << escaped(x_name) << "</text><text x='" << x0 - 4 << "' y='"
      << bottom + 11 << "' text-anchor='end' class='axis'>" << escaped(y_name) << "</text>\n";
}

}  // namespace

int shade_of_error(double error) {
  if (!(error > 0.0)) return error == 0.0 ? 0 : 7;
  return std::clamp(static_cast<int>(std::floor((std::log10(error) + 14.0) / 2.0)) + 1, 0, 7);
}

std::string power_of_ten(int halves) {
  const int whole = static_cast<int>(std::floor(0.5 * halves));
  return (halves % 2 == 0 ? "1e" : "3e") + std::to_string(whole);
}

std::string svg_of(const std::vector<Grid>& grids, int per_row, const std::string& x_name, const std::string& y_name) {
  double w = 0.0, h = 0.0;
  for (const Grid& g : grids) {
    w = std::max(w, left_of(g) + side * static_cast<double>(g.columns.size()) + right);
    w = std::max(w, left_of(g) + 6.6 * static_cast<double>(g.title.size()) + right);
    h = std::max(h, above + side * static_cast<double>(g.rows.size()) + below_of(g));
  }
  const int count = static_cast<int>(grids.size()), across = std::min(per_row, count);
  const double width = w * across, height = h * ((count + per_row - 1) / per_row);
  std::ostringstream out;
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << width << ' ' << height << "' width='" << width
      << "' height='" << height << "'>\n";
  for (int i = 0; i < count; ++i)
    draw(out, w * (i % per_row), h * (i / per_row), grids[static_cast<std::size_t>(i)], x_name, y_name);
  out << "</svg>\n";
  return out.str();
}

}  // namespace maps
