// Scene: a mesh of yours.
#include <palpate/core/setup_error.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/diagnose.hpp>

#include "scenes.hpp"

namespace live {

TouchScene make_own_scene(const std::string& file, const std::string& fix, const std::string& touch) {
  TouchScene scene;
  scene.name = file;
  scene.text = "Your mesh.";
  scene.mesh = io::read_mesh<Tet4>(file);
  scene.tissues = {{.region = everywhere}};

  // A finger whose size suits the body; without groups it lies on its lowest tenth, and the upper half is touched.
  const MeshDiagnosis d = diagnose<Tet4>(scene.mesh);
  const Vector3 size = d.box_max - d.box_min, middle = 0.5 * (d.box_min + d.box_max);
  const double radius = 0.04 * size.norm();
  scene.tools = {SphereTool{.radius = radius}};
  scene.starts = {middle + Vector3(0.0, 0.0, 0.5 * size.z() + 3.0 * radius)};
  const auto part = [](const std::string& group, where::PointSet otherwise) {
    return group.empty() ? Selection(std::move(otherwise)) : Selection(group);
  };
  scene.conditions.fix(part(fix, where::below(d.box_min + 0.1 * size)))
      .touch(part(touch, where::above(middle)), {.radius = radius});

  scene.compositions = {Composition::smoothed, Composition::tet4, Composition::tet10, Composition::quasi_newton,
                        Composition::cuttable};
  scene.camera.target = middle;
  scene.camera.distance = 2.2 * size.norm();
  scene.script = "0.3 press 0.5 0.45\n0.3..1.0 push 4\n1.0..2.0 drag 0.55 0.45\n2.0..2.4 push -4\n2.5 release\n";
  return scene;
}

}  // namespace live
