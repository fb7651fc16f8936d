// Drawings of the scene: from the front and above, and a section.
#pragma once

#include "coupled_scene.hpp"

#include "../01-touch/chart.hpp"

#include <palpate/post/colour_map.hpp>

namespace bullet_example {

using touch::text;

/// Instruments as spheres in a row, so that parts of them can be hidden.
struct DrawnSphere {
  Vector3 centre;
  double radius;
};
inline std::vector<DrawnSphere> spheres_of(const CoupledScene& scene) {
  std::vector<DrawnSphere> spheres;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Instrument& b = scene.instrument(i);
    const Vector3 axis = to_eigen(scene.rigid().pose(i).getBasis().getColumn(2));
    const int steps = b.half_length > 0.0 ? 24 : 0;
    for (int k = 0; k <= steps; ++k)
      spheres.push_back(
          {scene.rigid().position(i) + (steps == 0 ? 0.0 : 2.0 * k / steps - 1.0) * b.half_length * axis, b.radius});
  }
  return spheres;
}

/// The boundary of the tissue as it is now.
inline std::vector<std::array<Vector3, 3>> skin_of(Tissue& tissue) {
  const VectorX u = tissue.displacement();
  std::vector<std::array<Vector3, 3>> skin;
  for (const auto& face : tissue.boundary()) {
    std::array<Vector3, 3> x;
    for (std::size_t a = 0; a < 3; ++a)
      x[a] = tissue.rest_position(face.nodes[a]) + u.segment<3>(3 * Index{face.nodes[a]});
    skin.push_back(x);
  }
  return skin;
}

/// Parallel projection; the farthest parts are drawn first. Millimetres.
inline std::string draw_view(Tissue& tissue, const CoupledScene& scene) {
  const Vector3 towards = Vector3(-0.3, -0.8, 0.55).normalized(), right = Vector3::UnitZ().cross(towards).normalized(),
                up = towards.cross(right), light = Vector3(-0.5, -0.4, 0.9).normalized();
  std::vector<std::pair<double, std::string>> parts;
  const auto x = [&](const Vector3& p) { return 1e3 * p.dot(right); };
  const auto y = [&](const Vector3& p) { return -1e3 * p.dot(up); };
  for (const auto& t : skin_of(tissue)) {
    const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    if (normal.dot(towards) <= 0.0) continue;
    const double lit = 0.35 + 0.65 * std::max(0.0, normal.dot(light));
    parts.emplace_back((t[0] + t[1] + t[2]).dot(towards) / 3.0,
                       text("<path d='M%.1f %.1fL%.1f %.1fL%.1f %.1fz' fill='rgb(%d,%d,%d)' stroke='#a66' "
                            "stroke-width='.1'/>",
                            x(t[0]), y(t[0]), x(t[1]), y(t[1]), x(t[2]), y(t[2]), static_cast<int>(235 * lit),
                            static_cast<int>(150 * lit), static_cast<int>(140 * lit)));
  }
  for (const DrawnSphere& b : spheres_of(scene))
    parts.emplace_back(b.centre.dot(towards), text("<circle cx='%.1f' cy='%.1f' r='%.1f' fill='url(#steel)'/>",
                                                   x(b.centre), y(b.centre), 1e3 * b.radius));
  std::ranges::stable_sort(parts, {}, &std::pair<double, std::string>::first);
  const Vector3 middle = tissue.origin() + 0.02 * Vector3::UnitZ();
  std::string svg = text(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='%.1f %.1f 190 145' width='760'><defs><radialGradient "
      "id='steel' "
      "cx='.35' cy='.3'><stop offset='0' stop-color='#eef'/><stop offset='1' "
      "stop-color='#567'/></radialGradient></defs>"
      "<rect x='%.1f' y='%.1f' width='190' height='145' fill='#fff'/>",
      x(middle) - 95.0, y(middle) - 75.0, x(middle) - 95.0, y(middle) - 75.0);
  for (const auto& part : parts) svg += part.second;
  return svg + text("<text x='%.1f' y='%.1f' font-size='5' font-family='sans-serif'>%.2f s</text></svg>\n",
                    x(middle) - 90.0, y(middle) - 68.0, scene.time());
}

/// The section at depth `at` [m]: outline of the tissue, circles of the instruments. Millimetres.
inline std::string draw_section(Tissue& tissue, const CoupledScene& scene, double at) {
  std::string lines;
  for (const auto& t : skin_of(tissue)) {
    std::vector<Vector3> cut;
    for (std::size_t a = 0; a < 3; ++a) {
      const Vector3 &p = t[a], &q = t[(a + 1) % 3];
      if ((p.y() < at) != (q.y() < at)) cut.push_back(p + (at - p.y()) / (q.y() - p.y()) * (q - p));
    }
    if (cut.size() == 2)
      lines += text("M%.2f %.2fL%.2f %.2f", 1e3 * cut[0].x(), -1e3 * cut[0].z(), 1e3 * cut[1].x(), -1e3 * cut[1].z());
  }
  std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-10 -125 170 130' width='760'><rect x='-10' y='-125' "
      "width='170' "
      "height='130' fill='#fff'/>";
  for (const DrawnSphere& b : spheres_of(scene)) {
    const double square = b.radius * b.radius - (b.centre.y() - at) * (b.centre.y() - at);
    if (square > 0.0)
      svg += text("<circle cx='%.2f' cy='%.2f' r='%.2f' fill='#9ab'/>", 1e3 * b.centre.x(), -1e3 * b.centre.z(),
                  1e3 * std::sqrt(square));
  }
  return svg + "<path d='" + lines + "' stroke='#a33' stroke-width='.6' fill='none' stroke-linecap='round'/>" +
         text(
             "<text x='-5' y='-118' font-size='5' font-family='sans-serif'>%.2f s, section at y = %.1f "
             "mm</text></svg>\n",
             scene.time(), 1e3 * at);
}

}  // namespace bullet_example
