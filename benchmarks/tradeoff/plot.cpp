// The plot of error over latency.
#include <cmath>
#include <ostream>

#include "../common/markup.hpp"
#include "page.hpp"

namespace tradeoff {
namespace {

/// Tooltip of a row with all its figures.
std::string hover(const Row& r) {
  return bench::escaped(r.name() + "\nset-up " + three_digits(1e3 * r.setup) + " ms, " + three_digits(1e-6 * r.bytes) +
                        " MB\ntick p50 " + three_digits(1e6 * r.p50) + " us, p99 " + three_digits(1e6 * r.p99) +
                        " us, worst " + three_digits(1e6 * r.worst) + " us\nforce error " + percent(r.force_small) +
                        " % (small), " + percent(r.force_large) + " % (large), in motion " + percent(r.in_motion) +
                        " %" + (r.verdict.empty() ? "" : "\n" + r.verdict) + (r.remark.empty() ? "" : "\n" + r.remark));
}

/// Short label that distinguishes the rows of a front.
std::string label(const Row& r) {
  std::string text = r.element;
  if (r.mesh != "as given") text += ", " + r.mesh;
  if (r.kinematics != "linear") text += ", " + r.kinematics;
  if (!r.solver.starts_with("Condensed")) text += ", " + r.solver;
  return text;
}

void text(std::ostream& out, double x, double y, const std::string& what, const char* style) {
  out << "<text x='" << x << "' y='" << y << "' font-size='11' " << style << '>' << what << "</text>\n";
}

/// Labels next to points, without overlap with other labels or marks, with a line to points that are not adjacent.
class Labels {
 public:
  Labels(double left, double right, double top, double bottom)
      : left_(left), right_(right), top_(top), bottom_(bottom) {}

  /// Reserves the area of a mark.
  void avoid(double x, double y) { taken_.push_back({x - 5.0, y - 5.0, x + 5.0, y + 5.0}); }
  void write(std::ostream& out, double x, double y, const std::string& what) {
    const double width = 5.6 * static_cast<double>(what.size());
    for (double away = 7.0; away < bottom_ - top_; away += 4.0)
      for (const double down : {-away, away + 6.0})
        for (const double from : {x + 7.0, x - 7.0 - width}) {
          const Box box{from, y + down - 10.0, from + width, y + down + 2.0};
          if (!is_free(box)) continue;
          taken_.push_back(box);
          if (away > 7.0)
            out << "<path d='M" << x << ' ' << y << 'L' << (from > x ? from : from + width) << ' ' << y + down - 4.0
                << "' stroke='#bbb'/>";
          text(out, from, y + down, bench::escaped(what), "fill='#222'");
          return;
        }
  }

 private:
  struct Box {
    double left, top, right, bottom;
  };
  bool is_free(const Box& box) const {
    if (box.left < left_ || box.right > right_ || box.top < top_ || box.bottom > bottom_) return false;
    return std::ranges::none_of(taken_, [&](const Box& other) {
      return box.left < other.right && other.left < box.right && box.top < other.bottom && other.top < box.bottom;
    });
  }

  double left_, right_, top_, bottom_;
  std::vector<Box> taken_;
};

/// Error over latency, both logarithmic, with the Pareto front.
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
    low_x_ = std::floor(std::max(low_x_, -6.5) - 0.1);  // limits the axis for rows whose ticks take almost no time
    high_x_ = std::ceil(high_x_ + 0.1);
    low_y_ = std::floor(2.0 * low_y_ - 0.1) / 2.0;
    high_y_ = std::ceil(2.0 * high_y_ + 0.1) / 2.0;
  }

  void write(std::ostream& out, double budget, double floor) const {
    out << "<svg xmlns='http://www.w3.org/2000/svg' font-family='sans-serif' viewBox='0 0 " << width << ' ' << height
        << "' role='img'>\n<rect width='" << width << "' height='" << height << "' fill='white'/>\n";
    grid(out);
    line(out, x(budget), top, x(budget), bottom, "stroke='#c33' stroke-dasharray='5 4'");
    text(out, x(budget) + 4, top + 12, "budget", "fill='#c33'");
    if (floor > 0.0 && std::log10(floor) > low_y_) {
      line(out, left, y(floor), right, y(floor), "stroke='#999' stroke-dasharray='2 3'");
      text(out, left + 4, y(floor) - 4, "error of the reference", "fill='#777'");
    }
    out << "<polyline fill='none' stroke='#222' stroke-width='1.2' points='";
    double last = top;
    const auto front = trade_off_of(rows_, error_, false).front();
    for (const MeasuredComposition& m : front) {
      out << x(m.latency) << ',' << last << ' ' << x(m.latency) << ',' << y(m.error) << ' ';
      last = y(m.error);
    }
    out << right << ',' << last << "'/>\n";
    Labels labels(left, right, top, bottom);
    for (const Row& r : rows_) {
      if (!std::isfinite(r.p99) || !std::isfinite(r.*error_)) continue;
      point(out, r);
      labels.avoid(x(r.p99), y(r.*error_));
    }
    for (const Row& r : rows_)
      if (std::ranges::count(front, r.name(), &MeasuredComposition::name) > 0)
        labels.write(out, x(r.p99), y(r.*error_), label(r));
    out << "</svg>\n";
  }

 private:
  static constexpr double width = 880, height = 460, left = 70, right = 840, top = 15, bottom = 410;

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
  /// The values 1, 2, 5, 10, ... between two powers of ten.
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
      if (!crowded) text(out, x(1e-6 * at), bottom + 16, number(at), "text-anchor='middle' fill='#555'");
    }
    for (const double at : round_values(low_y_ + 2.0, high_y_ + 2.0)) {
      line(out, left, y(1e-2 * at), right, y(1e-2 * at), "stroke='#e4e4e4'");
      text(out, left - 6, y(1e-2 * at) + 4, number(at) + " %", "text-anchor='end' fill='#555'");
    }
    text(out, 0.5 * (left + right), bottom + 36, "p99 of a tick [us]", "text-anchor='middle' fill='#333'");
  }
  void point(std::ostream& out, const Row& r) const {
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

}  // namespace

void write_plot(std::ostream& out, const std::vector<Row>& rows, double Row::*error, double budget, double floor) {
  Plot(rows, error).write(out, budget, floor);
}

}  // namespace tradeoff
