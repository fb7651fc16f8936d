// Scene: find the stiff lesion.
//
// A liver lies on its underside. Somewhere under the touchable front is a lump ten times as stiff as the rest; nothing
// of it can be seen. Press at several places and compare the forces, guess, then reveal it with key L.
#include <palpate/io/read_msh.hpp>

#include "scenes.hpp"

namespace live {

TouchScene palpate_scene() {
  TouchScene scene;
  scene.name = "palpate";
  scene.text =
      "Somewhere under the front is a lump ten times as stiff as the rest. Press, compare, guess; then reveal it.";

  // 1. The organ: a mesh with named groups, and a material for each of its regions.
  scene.mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  scene.tissues = {{.region = "parenchyma", .youngs_modulus = 5e3}, {.region = "lesion", .youngs_modulus = 50e3}};
  scene.hidden_region = "lesion";

  // 2. The tool: a finger tip of 10 mm radius.
  scene.tools = {SphereTool{.radius = 10e-3}};
  scene.starts = {{-0.03, -0.05, 0.08}};

  // 3. The conditions: fixed at the ligament and where it lies. Only the upper front can be touched, so only its nodes
  //    are kept. The radius is that of the tool, for which the set-up measures the error of the forces.
  const auto upper_front = where::inside([](const Vector3& x) { return x.z() > 0.005 && x.y() < 0.035; });
  scene.conditions.fix("ligament").fix(facing_down(scene.mesh)).touch(upper_front, {.radius = 10e-3}).render("surface");

  // 4. What it is computed with. Switch while you touch, and compare force, time and error.
  scene.compositions = {Composition::smoothed, Composition::tet4, Composition::tet10, Composition::quasi_newton,
                        Composition::cuttable};

  // 5. Where one looks from, and what a hand without a hand does.
  scene.camera = {.target = {-0.01, -0.01, 0.01}, .yaw = -1.75, .pitch = 0.75, .distance = 0.42};
  scene.script = R"(
    0.1 move 0.46 0.42
    0.3 press 0.46 0.42
    0.3..0.9 push 7
    0.9..2.3 drag 0.34 0.48      # across the lesion
    2.3..2.6 push -9
    2.7 release
    2.8 press 0.40 0.52
    2.8..3.4 push 7
    3.4..4.0 drag 0.42 0.44
    4.0..4.3 push -9
    4.4 release
  )";
  return scene;
}

}  // namespace live
