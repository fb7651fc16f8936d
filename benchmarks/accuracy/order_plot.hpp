// Convergence plots as SVG: error over the number of cells, both logarithmic.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace accuracy {

/// One panel with curves and reference lines of integer order. Coordinates in pixels of the picture.
class OrderPlot {
 public:
  OrderPlot(double left, std::string title) : left_(left), title_(std::move(title)) {}

  void add(std::string name, std::string colour, bool dashed, std::vector<std::array<double, 2>> points) {
    curves_.push_back({std::move(name), std::move(colour), dashed, std::move(points)});
  }

  std::string svg() {
    for (const Curve& c : curves_)
      for (const auto& p : c.points)
        for (std::size_t k = 0; k < 2; ++k) {
          low_[k] = std::min(low_[k], p[k]);
          high_[k] = std::max(high_[k], p[k]);
        }
    low_[1] = std::pow(10.0, std::floor(std::log10(low_[1])));
    high_[1] = std::pow(10.0, std::ceil(std::log10(high_[1])));
    std::string s = "<g font-family='sans-serif' font-size='11'>\n" + label(left_ + 40, 24, title_, 14);
    grid(s);
    double key = 46;
    for (const Curve& c : curves_) draw(s, c, key += 14);
    return s + "</g>\n";
  }

 private:
  struct Curve {
    std::string name, colour;
    bool dashed;
    std::vector<std::array<double, 2>> points;
  };
  static constexpr double width = 320, top = 200, bottom = 520;

  double x(double v) const { return left_ + 50 + width * std::log(v / low_[0]) / std::log(high_[0] / low_[0]); }
  double y(double v) const { return bottom - (bottom - top) * std::log(v / low_[1]) / std::log(high_[1] / low_[1]); }
  static std::string number(double v) {
    std::array<char, 32> b{};
    std::snprintf(b.data(), b.size(), "%.4g", v);
    return b.data();
  }
  static std::string label(double px, double py, const std::string& what, int size = 11) {
    return "<text x='" + number(px) + "' y='" + number(py) + "' font-size='" + std::to_string(size) + "'>" + what +
           "</text>\n";
  }
  static std::string line(double x0, double y0, double x1, double y1, const std::string& style) {
    return "<line x1='" + number(x0) + "' y1='" + number(y0) + "' x2='" + number(x1) + "' y2='" + number(y1) + "' " +
           style + "/>\n";
  }

  void grid(std::string& s) const {
    for (double n = 2.0; n <= high_[0] * 1.01; n *= 2.0)
      if (n >= low_[0] * 0.99)
        s += line(x(n), top, x(n), bottom, "stroke='#ddd'") + label(x(n) - 4, bottom + 16, number(n));
    for (double v = low_[1]; v <= high_[1] * 1.01; v *= 10.0)
      s += line(left_ + 50, y(v), left_ + 50 + width, y(v), "stroke='#ddd'") + label(left_ + 4, y(v) + 4, number(v));
    s += label(left_ + 150, bottom + 34, "cells along the cube's edge");
    const double a = low_[0], b = 2.5 * a;
    for (int order : {1, 2, 3}) {
      const double at = 20.0 * low_[1], end = at * std::pow(b / a, -order);
      s += line(x(a), y(at), x(b), y(end), "stroke='#888' stroke-dasharray='2 3'") +
           label(x(b) + 3, y(end), std::to_string(order));
    }
  }
  void draw(std::string& s, const Curve& c, double key) const {
    const std::string dash = c.dashed ? " stroke-dasharray='6 4'" : "";
    std::string path;
    for (const auto& p : c.points) {
      path += number(x(p[0])) + ',' + number(y(p[1])) + ' ';
      s += "<circle cx='" + number(x(p[0])) + "' cy='" + number(y(p[1])) + "' r='3' fill='" + c.colour + "'/>\n";
    }
    s += "<polyline points='" + path + "' fill='none' stroke='" + c.colour + "' stroke-width='1.5'" + dash + "/>\n" +
         line(left_ + 50, key - 4, left_ + 80, key - 4, "stroke='" + c.colour + "' stroke-width='2'" + dash) +
         label(left_ + 88, key, c.name);
  }

  double left_;
  std::string title_;
  std::vector<Curve> curves_;
  std::array<double, 2> low_{1e9, 1e9}, high_{-1e9, -1e9};
};

}  // namespace accuracy
