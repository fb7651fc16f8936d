// Scene: cut.
//
// The organ is pulled at one end, so a slit gapes. The blade renders the force of cutting: toughness times the length
// of edge in the tissue. Cuts are computed in the background; ticks never wait for them.
#include <palpate/io/read_msh.hpp>
#include <palpate/mesh/diagnose.hpp>

#include "scenes.hpp"

namespace live {

TouchScene cut_scene() {
  TouchScene scene;
  scene.name = "cut";
  scene.text = "A blade, its edge along the view. Set it on the organ, push it in with the wheel, and drag.";

  scene.mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  scene.tissues = {{.region = everywhere, .youngs_modulus = 5e3}};

  // 1. The tool: a sharp edge of 50 mm, fixed in the world.
  scene.tools = {BladeTool{.edge = {0.0, 0.05, 0.0}, .toughness = 40.0}};
  scene.starts = {{-0.02, -0.03, 0.09}};

  // 2. Fixed at the right end, pulled by 10 mm at the left one, touchable everywhere.
  const MeshDiagnosis d = diagnose<Tet4>(scene.mesh);
  scene.conditions.fix(where::below(d.box_min + Vector3(0.02, 0.0, 0.0), Vector3::UnitX()))
      .prescribe(where::above(d.box_max - Vector3(0.02, 0.0, 0.0), Vector3::UnitX()), {10e-3, 0.0, 0.0})
      .touch("surface");

  // 3. Only this composition can be cut.
  scene.compositions = {Composition::cuttable};

  scene.camera = {.target = {-0.005, 0.0, 0.015}, .yaw = -1.75, .pitch = 1.0, .distance = 0.40};
  scene.script = R"(
    0.1 move 0.46 0.40
    0.3 press 0.46 0.40
    0.3..1.6 push 28
    1.6..2.4 drag 0.46 0.50
    2.5..3.0 push -40
    3.1 release
  )";
  return scene;
}

}  // namespace live
