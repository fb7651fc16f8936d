// Charts as SVG embedded in the page.
#pragma once

#include <palpate/palpate.hpp>

#include <cstdarg>

namespace touch {

using palpate::Vector2;

/// printf into a string.
[[gnu::format(printf, 1, 2)]] inline std::string text(const char* format, ...) {
  std::array<char, 512> line{};
  va_list values;
  va_start(values, format);
  std::vsnprintf(line.data(), line.size(), format, values);
  va_end(values);
  return line.data();
}

/// The smallest round number (1, 2, 3, 4, 5, 6 or 8 times a power of ten) that is not less than `value`.
inline double round_up(double value, std::initializer_list<double> factors = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : factors)
    if (factor * power >= value * (1.0 - 1e-9)) return factor * power;
  return 10.0 * power;
}

/// An axis of a chart: label, range, and whether it is logarithmic.
struct Axis {
  std::string label;
  double low, high;
  bool logarithmic = false;

  double fraction(double value) const {
    if (logarithmic) return std::log(std::max(value, low) / low) / std::log(high / low);
    return (value - low) / (high - low);
  }
  std::vector<double> ticks() const {
    std::vector<double> all;
    if (logarithmic) {
      for (double t = std::pow(10.0, std::ceil(std::log10(low) - 1e-9)); t <= high * 1.0001; t *= 10.0)
        all.push_back(t);
    } else {
      const double step = round_up((high - low) / 6.0, {1.0, 2.0, 5.0});
      for (double t = std::ceil(low / step - 1e-9) * step; t <= high + 1e-9 * step; t += step) all.push_back(t);
    }
    return all;
  }
};

/// An axis from zero to at least `most`, ending at a tick.
inline Axis from_zero(std::string label, double most) {
  most = std::max(most, 1e-9);
  const double step = round_up(most / 6.0, {1.0, 2.0, 5.0});
  return {std::move(label), 0.0, step * std::ceil(most / step - 1e-9)};
}

/// A chart under construction: a frame with ticks, to which lines and bars are added.
class Chart {
 public:
  Chart(std::string title, Axis x, Axis y, double height = 220.0)
      : x_(std::move(x)), y_(std::move(y)), height_(height) {
    body_ = text("<svg class=chart viewBox='0 0 %g %g' role=img aria-label='%s'>", width, height_, title.c_str());
    const double bottom = height_ - below;
    for (const double t : y_.ticks())
      body_ +=
          text("<line class=grid x1=%g x2=%g y1=%.1f y2=%.1f /><text class=tick x=%g y=%.1f text-anchor=end>%s</text>",
               left, width - right, place_y(t), place_y(t), left - 6.0, place_y(t) + 4.0, short_number(t).c_str());
    for (const double t : x_.ticks())
      body_ += text(
          "<line class=axis x1=%.1f x2=%.1f y1=%g y2=%g /><text class=tick x=%.1f y=%g text-anchor=middle>%s</text>",
          place_x(t), place_x(t), bottom, bottom + 4.0, place_x(t), bottom + 17.0, short_number(t).c_str());
    body_ += text("<line class=axis x1=%g x2=%g y1=%g y2=%g /><text class=label x=%g y=%g text-anchor=middle>%s</text>",
                  left, width - right, bottom, bottom, 0.5 * (left + width - right), height_ - 4.0, x_.label.c_str());
    body_ += text("<text class=label x=%g y=13>%s</text>", 2.0, y_.label.c_str());
  }

  void line(const std::vector<Vector2>& points, const char* style) {
    body_ += text("<polyline class='line %s' points='", style);
    for (const Vector2& p : points) body_ += text("%.1f,%.1f ", place_x(p[0]), place_y(p[1]));
    body_ += "'/>";
  }
  /// The area between two lines with the same x.
  void band(const std::vector<Vector2>& low, const std::vector<Vector2>& high, const char* style) {
    body_ += text("<polygon class='band %s' points='", style);
    for (const Vector2& p : low) body_ += text("%.1f,%.1f ", place_x(p[0]), place_y(p[1]));
    for (std::size_t i = high.size(); i-- > 0;) body_ += text("%.1f,%.1f ", place_x(high[i][0]), place_y(high[i][1]));
    body_ += "'/>";
  }
  void bar(double from, double to, double value, const char* style) {
    const double x = place_x(from) + 0.5, top = place_y(value);
    body_ += text("<rect class='%s' x=%.1f width=%.1f y=%.1f height=%.1f />", style, x, place_x(to) - x - 0.5, top,
                  std::max(0.0, height_ - below - top));
  }
  /// A vertical line at x with a label.
  void mark(double x, const char* word) {
    body_ +=
        text("<line class=mark x1=%.1f x2=%.1f y1=%g y2=%g /><text class=tick x=%.1f y=%g text-anchor=end>%s</text>",
             place_x(x), place_x(x), above, height_ - below, place_x(x) - 4.0, above + 10.0, word);
  }
  /// A marker that the script of the page moves along x: a vertical line (`now`) or a dot (`here`).
  void cursor(const char* kind) {
    body_ += text("<g class='cursor %s' data-x='%g,%g,%g,%g' data-y='%g,%g,%g,%g'>", kind, x_.low, x_.high, left,
                  width - right, y_.low, y_.high, height_ - below, above);
    body_ += std::string_view(kind) == "here" ? std::string("<circle r=4.5 />")
                                              : text("<line x1=0 x2=0 y1=%g y2=%g />", above, height_ - below);
    body_ += "</g>";
  }
  std::string svg() const { return body_ + "</svg>"; }

 private:
  static constexpr double width = 560.0, left = 50.0, right = 14.0, above = 22.0, below = 40.0;

  double place_x(double v) const { return left + (width - right - left) * x_.fraction(v); }
  double place_y(double v) const { return height_ - below - (height_ - below - above) * y_.fraction(v); }
  static std::string short_number(double v) { return std::abs(v) < 1e-12 ? "0" : text("%.6g", v); }

  Axis x_, y_;
  double height_;
  std::string body_;
};

}  // namespace touch
