// One moment of a session as a static drawing: still.svg.
#pragma once

#include <Eigen/Geometry>

#include "pictures.hpp"

namespace touch {

/// Parallel projection onto the page with the painter's algorithm: the farthest parts are drawn first.
class Still {
 public:
  /// Looks at `centre` [m] from a direction between `outward` and the horizon.
  Still(const Vector3& centre, const Vector3& outward, double size) : centre_(centre), scale_(0.8 * width / size) {
    towards_ = (outward.normalized() - 0.5 * Vector3::UnitY() - 0.35 * Vector3::UnitX()).normalized();
    right_ = Vector3::UnitZ().cross(towards_).normalized();
    up_ = towards_.cross(right_);
  }

  void triangle(const Vector3& a, const Vector3& b, const Vector3& c, const Rgb& colour) {
    const Vector3 normal = (b - a).cross(c - a).normalized();
    if (normal.dot(towards_) <= 0.0) return;
    const double light = 0.45 + 0.55 * std::max(0.0, normal.dot((towards_ + 0.6 * up_ - 0.4 * right_).normalized()));
    Rgb shaded = colour;
    for (double& component : shaded) component *= light;
    const std::string fill = to_hex(shaded);
    add((a + b + c).dot(towards_) / 3.0,
        "<path d='M" + point(a) + 'L' + point(b) + 'L' + point(c) + "z' fill='" + fill + "' stroke='" + fill + "'/>");
  }
  void sphere(const Vector3& at, double radius) {
    add(at.dot(towards_) + radius,
        text("<circle cx='%.1f' cy='%.1f' r='%.1f' fill='url(#sphere)'/>", x(at), y(at), scale_ * radius));
  }
  /// Drawn on top of everything.
  void arrow(const Vector3& from, const Vector3& to) {
    add(infinity, text("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#111' stroke-width='3' "
                       "marker-end='url(#head)'/>",
                       x(from), y(from), x(to), y(to)));
  }
  /// A colour bar at the left, with the values at its ends.
  void legend(const ColourScale& scale, const std::string& caption) {
    std::string bar;
    for (int i = 0; i < 32; ++i)
      bar += text("<rect x='24' y='%d' width='14' height='7' fill='%s'/>", 250 - 6 * i,
                  to_hex(colour_at(scale.map(), i / 31.0)).c_str());
    for (int i = 0; i <= 2; ++i)
      bar += text("<text x='44' y='%d'>%.3g</text>", 259 - 93 * i, 0.5e-3 * i * scale.high());
    add(infinity, bar + "<text x='24' y='50'>von Mises [kPa]</text><text x='24' y='404'>" + caption + "</text>");
  }

  std::string svg() {
    std::ranges::stable_sort(parts_, {}, &std::pair<double, std::string>::first);
    std::string out = text(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %g %g' font-family='sans-serif' "
        "font-size='13' stroke-width='.4'>",
        width, height);
    out +=
        "<defs><radialGradient id='sphere' cx='.35' cy='.3'><stop offset='0' stop-color='#fff'/>"
        "<stop offset='1' stop-color='#666'/></radialGradient><marker id='head' orient='auto' markerWidth='5' "
        "markerHeight='5' refX='1.5' refY='2.5'><path d='M0 0L5 2.5L0 5z'/></marker></defs>"
        "<rect width='100%' height='100%' fill='#fff'/>";
    for (const auto& part : parts_) out += part.second;
    return out + "</svg>\n";
  }

 private:
  static constexpr double width = 640.0, height = 420.0;

  void add(double depth, std::string part) { parts_.emplace_back(depth, std::move(part)); }
  double x(const Vector3& p) const { return 0.53 * width + scale_ * (p - centre_).dot(right_); }
  double y(const Vector3& p) const { return 0.52 * height - scale_ * (p - centre_).dot(up_); }
  std::string point(const Vector3& p) const { return text("%.1f %.1f", x(p), y(p)); }

  Vector3 centre_, towards_, right_, up_;
  double scale_;
  std::vector<std::pair<double, std::string>> parts_;
};

/// The organ at the moment of the largest force: its surface coloured by stress, the sphere, the force on it.
inline std::string draw_still(const Organ& organ, const TouchPath& path, const std::vector<Picture>& pictures) {
  const Picture& p = *std::ranges::max_element(pictures, {}, [](const Picture& q) { return q.force.norm(); });
  Vector3 low = organ.rest_position(0), high = low;
  double most = 0.0;
  for (const NodeId node : organ.rendered_nodes()) {
    low = low.cwiseMin(organ.rest_position(node));
    high = high.cwiseMax(organ.rest_position(node));
    most = std::max(most, p.von_mises[node]);
  }
  const Vector3 size = high - low;
  const ColourScale colours(0.0, round_up(0.5 * most));  // only a few nodes under the sphere exceed this
  Still still(0.5 * (low + high), path.outward(), size.maxCoeff());
  const auto moved = [&](NodeId n) {
    return Vector3(organ.rest_position(n) + p.displacement.segment<3>(3 * Index{n}));
  };
  for (const auto& face : organ.boundary()) {
    double stress = 0.0;
    for (const NodeId n : face.nodes) stress += p.von_mises[n] / 3.0;
    still.triangle(moved(face.nodes[0]), moved(face.nodes[1]), moved(face.nodes[2]), colours(stress));
  }
  still.sphere(p.sphere, tool.radius);
  const double per_newton = 0.25 * size.maxCoeff() / p.force.norm();
  still.arrow(p.sphere, p.sphere + per_newton * p.force);
  still.legend(colours, text("A sphere of %g mm presses %.1f mm deep; arrow: the force on it, %.2f N",
                             1e3 * tool.radius, 1e3 * p.penetration, p.force.norm()));
  return still.svg();
}

}  // namespace touch
