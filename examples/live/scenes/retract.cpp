// Scene: pull the thin lobe aside.
//
// At large strain and rotation linear elasticity is wrong: a lobe that is lifted would grow. Here each step of the
// background finds the equilibrium of a neo-Hookean organ, and every tick solves the contact on the newest one.
#include <palpate/io/read_msh.hpp>

#include "scenes.hpp"

namespace live {

TouchScene retract_scene() {
  TouchScene scene;
  scene.name = "retract";
  scene.text = "Take a pad of the thin lobe with key G while the retractor touches it, and lift it by dragging.";

  // 1. The same organ, with one material: the lump does not matter here.
  scene.mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  scene.tissues = {{.region = everywhere, .youngs_modulus = 5e3}};

  // 2. While button 1 is pressed (key G), the tool holds the vertices within 14 mm of the point that it touches: a
  //    single one would be pulled out of the surface as a spike. It may be lifted by 30 mm. Pushed into the organ by
  //    more than 12 mm the thin lobe would buckle.
  scene.tools = {SphereTool{.radius = 6e-3}};
  scene.session.grasp_buttons = 1;
  scene.session.contact.grasp_radius = 14e-3;
  scene.range = {.radius = 30e-3, .inward = -Vector3::UnitX(), .most_inward = 12e-3};
  scene.starts = {{0.08, -0.03, 0.06}};

  // 3. The lobe is free; the right half is supported by its ligament and by what it lies on.
  scene.conditions.fix("ligament")
      .fix(where::below({-0.02, 0.0, 0.0}, Vector3::UnitX()))
      .touch(where::above({0.035, 0.0, 0.0}, Vector3::UnitX()))
      .render("surface");

  // 4. Large strain, in real time.
  scene.compositions = {Composition::quasi_newton, Composition::smoothed};

  scene.camera = {.target = {0.03, 0.0, 0.015}, .yaw = -1.5, .pitch = 0.45, .distance = 0.45};
  scene.script = R"(
    0.1 move 0.66 0.50
    0.3 press 0.66 0.50
    0.3..0.6 push 4
    0.7 key G
    0.8..2.0 drag 0.62 0.36
    2.2..3.2 drag 0.66 0.48
    3.3 key G
    3.4 release
  )";
  return scene;
}

}  // namespace live
