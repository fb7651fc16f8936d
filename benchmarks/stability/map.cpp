// The map as a picture: a panel per device and hand, rate over delay; darker cells are stiffer.
#include <palpate/core/setup_error.hpp>
#include "stability.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>

namespace stability {
namespace {

std::string text(double x, double y, const std::string& what, int size, const char* style = "") {
  std::array<char, 400> b{};
  std::snprintf(b.data(), b.size(), "<text x='%.4g' y='%.4g' font-size='%d' %s>%s</text>\n", x, y, size, style,
                what.c_str());
  return b.data();
}
std::string short_number(double v) {
  std::array<char, 32> b{};
  if (v >= highest) return "any";
  if (v < 1e3)
    std::snprintf(b.data(), b.size(), "%.0f", v);
  else
    std::snprintf(b.data(), b.size(), v < 1e4 ? "%.1fk" : "%.0fk", 1e-3 * v);
  return b.data();
}

/// Colour from pale rose (10 N/m) to dark blue (100 kN/m), interpolated linearly in RGB over the logarithm.
std::string colour(double stiffness) {
  const double t = std::clamp((std::log10(std::max(stiffness, 1.0)) - 1.0) / 4.0, 0.0, 1.0);
  std::array<char, 32> b{};
  std::snprintf(b.data(), b.size(), "rgb(%.0f,%.0f,%.0f)", 255.0 - 255.0 * t, 210.0 - 153.0 * t, 202.0 - 63.0 * t);
  return b.data();
}

}  // namespace

void write_map(const std::vector<Cell>& cells, const std::string& path) {
  constexpr double w = 62, h = 26, gap = 40, left = 130, top = 80;
  const double panel_w = w * delays.size() + gap, panel_h = h * rates.size() + gap;
  const double width = left + hand_count * panel_w, height = top + panel_h * static_cast<double>(devices().size()) + 10;
  std::ofstream out(path);
  out << "<svg xmlns='http://www.w3.org/2000/svg' font-family='sans-serif' width='" << width << "' height='" << height
      << "' viewBox='0 0 " << width << ' ' << height << "'>\n<rect width='100%' height='100%' fill='white'/>\n"
      << text(10, 22, "Largest wall stiffness [N/m] that a simulated device renders without oscillation", 15)
      << text(10, 40, "rate of the loop over delay in ticks; dashed: below the stiffness the device is rated for", 11);
  for (const Cell& c : cells) {
    const double px = left + panel_w * static_cast<double>(c.hand - hands().data());
    const double py = top + panel_h * static_cast<double>(c.device - devices().data());
    const auto row = static_cast<double>(std::find(rates.begin(), rates.end(), c.rate) - rates.begin());
    const double x = px + w * c.delay, y = py + h * row;
    const bool dark = c.stable > 1e3;
    out << "<rect x='" << x << "' y='" << y << "' width='" << w - 2 << "' height='" << h - 2 << "' fill='"
        << colour(c.stable) << "'"
        << (c.stable < c.device->options.limits.stiffness ? " stroke='#333' stroke-dasharray='3 3'" : "") << "/>\n"
        << text(x + 8, y + 16, short_number(c.stable), 11, dark ? "fill='white'" : "fill='#222'");
    if (c.delay == 0 && c.hand == hands().data())
      out << text(left - 52, y + 16, std::to_string(static_cast<int>(c.rate)) + " Hz", 11);
    if (row == 0.0) out << text(x + 24, py - 4, std::to_string(c.delay), 10);
    if (row == 0.0 && c.delay == 0) {
      out << text(px, py - 16, std::string(c.hand->name), 12);
      if (c.hand == hands().data()) out << text(10, py + 16, c.device->name, 11, "font-weight='bold'");
    }
  }
  out << "</svg>\n";
}

}  // namespace stability
