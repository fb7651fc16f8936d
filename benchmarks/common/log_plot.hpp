// A chart with logarithmic axes, written as SVG.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace bench {

using Point = std::array<double, 2>;

/// y = factor x^exponent, by least squares on the logarithms of the points with x >= `from`.
struct PowerLaw {
  double factor = 0.0, exponent = 0.0;
  double at(double x) const { return factor * std::pow(x, exponent); }
};
inline PowerLaw fit(const std::vector<Point>& points, double from) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const auto& [px, py] : points) {
    if (px < from) continue;
    const double x = std::log(px), y = std::log(py);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  if (n < 2.0) return {};
  const double exponent = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {std::exp((sy - exponent * sx) / n), exponent};
}

/// One panel of a picture. Coordinates in pixels of the picture.
class LogPlot {
 public:
  /// `along`: quantity and unit of the horizontal axis.
  LogPlot(double left, std::string title, std::string unit, std::string along)
      : left_(left), title_(std::move(title)), unit_(std::move(unit)), along_(std::move(along)) {}

  /// Adds points joined by a line. `fitted`: adds the power law for x >= `from` as a dashed line, and its exponent to
  /// the name.
  void add(std::string name, std::string colour, std::vector<Point> points, double from, bool fitted) {
    curves_.push_back({std::move(name), std::move(colour), std::move(points), from, fitted});
  }

  double height() const { return bottom() + 50.0; }
  std::string svg() {
    find_range();
    std::string s =
        "<g font-family='sans-serif' font-size='12'>\n" + text(left_, 20, title_ + " [" + unit_ + "]", "14");
    grid(s);
    double key = 42;
    for (const Curve& c : curves_) curve(s, c, key += 16);
    return s + "</g>\n";
  }

 private:
  struct Curve {
    std::string name, colour;
    std::vector<Point> points;
    double from;
    bool fitted;
  };
  static constexpr double width = 300;
  double top() const { return 46.0 + 16.0 * std::max(4.0, static_cast<double>(curves_.size())); }
  double bottom() const { return top() + 290.0; }

  void find_range() {
    for (const Curve& c : curves_)
      for (const Point& p : c.points)
        for (std::size_t k = 0; k < 2; ++k) {
          low_[k] = std::min(low_[k], std::floor(std::log10(p[k])));
          high_[k] = std::max(high_[k], std::ceil(std::log10(p[k])));
        }
  }
  double x(double v) const { return left_ + 40 + width * (std::log10(v) - low_[0]) / (high_[0] - low_[0]); }
  double y(double v) const { return bottom() - (bottom() - top()) * (std::log10(v) - low_[1]) / (high_[1] - low_[1]); }

  static std::string number(double v) {
    std::array<char, 32> b{};
    std::snprintf(b.data(), b.size(), "%.4g", v);
    return b.data();
  }
  static std::string text(double px, double py, const std::string& what, const char* size = "11") {
    return "<text x='" + number(px) + "' y='" + number(py) + "' font-size='" + size + "'>" + what + "</text>\n";
  }
  static std::string line(Point a, Point b, const std::string& style) {
    return "<line x1='" + number(a[0]) + "' y1='" + number(a[1]) + "' x2='" + number(b[0]) + "' y2='" + number(b[1]) +
           "' " + style + "/>\n";
  }

  void grid(std::string& s) const {
    for (double d = low_[0]; d <= high_[0]; ++d) {
      const double v = std::pow(10.0, d);
      s += line({x(v), top()}, {x(v), bottom()}, "stroke='#ddd'") + text(x(v) - 14, bottom() + 16,
                                                                         d < 3   ? number(v)
                                                                         : d < 6 ? number(1e-3 * v) + "k"
                                                                                 : number(1e-6 * v) + "M");
    }
    for (double d = low_[1]; d <= high_[1]; ++d) {
      const double v = std::pow(10.0, d);
      s += line({left_ + 40, y(v)}, {left_ + 40 + width, y(v)}, "stroke='#ddd'") + text(left_, y(v) + 4, number(v));
    }
    s += text(left_ + 150, bottom() + 34, along_);
  }
  void curve(std::string& s, const Curve& c, double key) const {
    std::string path;
    for (const Point& p : c.points) {
      const std::string at = number(x(p[0])) + ',' + number(y(p[1]));
      path += at + ' ';
      s += "<circle cx='" + number(x(p[0])) + "' cy='" + number(y(p[1])) + "' r='3.5' fill='" + c.colour + "'/>\n";
    }
    s += "<polyline points='" + path + "' fill='none' stroke='" + c.colour + "' stroke-width='1.5'/>\n";
    std::string name = c.name;
    const PowerLaw power_law = fit(c.points, c.from);
    if (c.fitted && power_law.factor > 0.0) {
      const double a = c.from, b = c.points.back()[0];
      s += line({x(a), y(power_law.at(a))}, {x(b), y(power_law.at(b))}, "stroke='#222' stroke-dasharray='4 4'");
      name += ": tets^" + number(std::round(100.0 * power_law.exponent) / 100.0 + 0.0);
    }
    s += "<rect x='" + number(left_ + 40) + "' y='" + number(key - 8) + "' width='10' height='10' fill='" + c.colour +
         "'/>\n" + text(left_ + 56, key + 1, name);
  }

  double left_;
  std::string title_, unit_, along_;
  std::vector<Curve> curves_;
  std::array<double, 2> low_{1e9, 1e9}, high_{-1e9, -1e9};
};

}  // namespace bench
