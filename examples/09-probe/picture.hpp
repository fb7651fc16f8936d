// A drawing of an indented body: its surface coloured by stress, with the probe.
#pragma once

#include <palpate/core/types.hpp>
#include <palpate/post/colour_map.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace probe {

using namespace palpate;

/// Parallel projection onto the page; the farthest parts are drawn first.
class Picture {
 public:
  Picture(const Vector3& centre, double size) : centre_(centre), scale_(560.0 / size) {}

  void triangle(const std::array<Vector3, 3>& x, const Rgb& colour) {
    const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    if (normal.dot(towards_) <= 0.0) return;
    Rgb lit = colour;
    for (double& c : lit) c *= 0.55 + 0.45 * std::max(0.0, normal.dot(light_));
    const std::string fill = to_hex(lit);
    parts_.emplace_back(
        (x[0] + x[1] + x[2]).dot(towards_) / 3.0,
        "<path d='M" + at(x[0]) + "L" + at(x[1]) + "L" + at(x[2]) + "z' fill='" + fill + "' stroke='" + fill + "'/>\n");
  }
  /// A capsule between two points; drawn on top of everything.
  void capsule(const Vector3& a, const Vector3& b, double radius) {
    for (const auto& [share, colour] : {std::pair{1.0, "#555"}, std::pair{0.55, "#888"}, std::pair{0.2, "#bbb"}})
      over_ += "<path d='M" + at(a) + "L" + at(b) + "' stroke='" + colour + "' stroke-linecap='round' stroke-width='" +
               number(2.0 * share * scale_ * radius) + "'/>\n";
  }
  void legend(const ColourScale& scale, const std::string& caption) {
    for (int i = 0; i < 48; ++i)
      over_ += "<rect x='20' y='" + number(280.0 - 5.0 * i) + "' width='14' height='6' stroke='none' fill='" +
               to_hex(colour_at(scale.map(), i / 47.0)) + "'/>\n";
    for (const double share : {0.0, 0.5, 1.0})
      over_ += "<text x='40' y='" + number(288.0 - 238.0 * share) + "'>" +
               number(1e-3 * (scale.low() + share * (scale.high() - scale.low()))) + "</text>\n";
    over_ += "<text x='20' y='28'>von Mises stress [kPa]</text><text x='20' y='400'>" + caption + "</text>\n";
  }
  std::string svg() {
    std::ranges::stable_sort(parts_, {}, &std::pair<double, std::string>::first);
    std::string out =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 720 420' font-family='sans-serif' font-size='13' "
        "stroke-width='.5'>\n<rect width='100%' height='100%' fill='#fff'/>\n";
    for (const auto& part : parts_) out += part.second;
    return out + over_ + "</svg>\n";
  }

 private:
  static std::string number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", x);
    return text;
  }
  std::string at(const Vector3& x) const {
    return number(380.0 + scale_ * (x - centre_).dot(right_)) + " " + number(200.0 - scale_ * (x - centre_).dot(up_));
  }

  Vector3 centre_;
  double scale_;
  Vector3 towards_ = Vector3(-0.45, -0.75, 0.6).normalized();
  Vector3 right_ = Vector3::UnitZ().cross(towards_).normalized(), up_ = towards_.cross(right_);
  Vector3 light_ = Vector3(-0.7, -0.3, 0.9).normalized();
  std::vector<std::pair<double, std::string>> parts_;
  std::string over_;
};

}  // namespace probe
