// Supports, touchable part and path of the sphere for an unknown mesh.
#pragma once

#include <palpate/io.hpp>
#include <palpate/mesh/diagnosis.hpp>
#include <palpate/palpate.hpp>

#include <cstdio>
#include <optional>
#include <string>

namespace own_mesh {

using namespace palpate;

struct Arguments {
  std::string file = PALPATE_EXAMPLE_DATA "/organ.msh";
  std::string fix, touch;  ///< names of groups; empty: see choose
  std::string labels;      ///< of ReadOptions
  std::string out = "build/own_mesh";
  double scale = 1.0;   ///< unit of the file [m]
  double radius = 0.0;  ///< of the sphere [m]; 0: see plan_press
  bool largest_piece = false;
};

/// A scene, a description of what was chosen, and the same as code.
struct Chosen {
  Scene scene;
  std::string constrained, touched;
  std::string code;
};

/// A point as code [m].
inline std::string code_of(const Vector3& p) {
  char text[96];
  std::snprintf(text, sizeof text, "{%.4g, %.4g, %.4g}", p.x(), p.y(), p.z());
  return text;
}

/// A point at a share of the height of the body (0 the lowest, 1 the highest point), z up.
inline Vector3 at_height(const MeshDiagnosis& diagnosis, double share) {
  return diagnosis.box_min + share * (diagnosis.box_max - diagnosis.box_min);
}

/// Uses the named groups; where none is named, "ligament" and "front" if the mesh has them, otherwise the lowest tenth
/// of the body is fixed and the surface of the upper half is touchable.
inline Chosen choose(const Mesh<Tet4>& mesh, const MeshDiagnosis& diagnosis, const Arguments& arguments) {
  Chosen c;
  const auto name_of = [&](const std::string& named, const char* fallback) {
    return !named.empty() ? named : mesh.find_group(fallback) != nullptr ? std::string(fallback) : std::string();
  };
  const std::string fix = name_of(arguments.fix, "ligament"), touch = name_of(arguments.touch, "front");
  c.constrained = fix.empty() ? "the lowest tenth" : "group '" + fix + "'";
  c.touched = touch.empty() ? "the upper half of the surface" : "group '" + touch + "'";
  c.scene.fix(fix.empty() ? Selection(where::below(at_height(diagnosis, 0.1))) : Selection(fix));
  c.scene.touch(touch.empty() ? Selection(where::above(at_height(diagnosis, 0.5))) : Selection(touch))
      .render("surface");
  const auto argument = [&](const std::string& group, const char* set, double share) {
    return group.empty() ? "where::" + std::string(set) + "(" + code_of(at_height(diagnosis, share)) + ")"
                         : "\"" + group + "\"";
  };
  c.code = "scene.fix(" + argument(fix, "below", 0.1) + ").touch(" + argument(touch, "above", 0.5) +
           ").render(\"surface\");";
  return c;
}

/// A sphere and its path: from above the surface to its deepest position, world frame [m].
struct Press {
  SphereTool sphere;
  Vector3 above, deepest;
  double depth;  ///< of the sphere in the surface at rest
};

/// Presses in the middle of the touchable surface, along the normal there, to a depth of a quarter of the radius. If no
/// radius is given, it is twice the mean edge length there: facets longer than half the radius make contact too stiff.
template <class Organ>
Press plan_press(const Organ& organ, double radius) {
  const ContactSurface& surface = organ.contact_surface();
  double edges = 0.0;
  Vector3 middle = Vector3::Zero();
  for (const auto& t : surface.triangles())
    for (std::size_t i = 0; i < 3; ++i) {
      edges += (surface.position(t[i]) - surface.position(t[(i + 1) % 3])).norm();
      middle += surface.position(t[i]);
    }
  const double count = 3.0 * static_cast<double>(surface.triangles().size());
  if (radius <= 0.0) radius = 2.0 * edges / count;
  const auto at = surface.closest(middle / count);
  const Vector3 outward = surface.normal(at.triangle);
  const double depth = 0.25 * radius;
  const auto world = [&](double height) { return Vector3(organ.to_world() * Vector3(at.point + height * outward)); };
  return {SphereTool{.radius = radius}, world(2.0 * radius), world(radius - depth), depth};
}

}  // namespace own_mesh
