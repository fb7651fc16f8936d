// Scene: pinch the lobe between two tools.
//
// Two devices, two tools, one contact problem: what one finger does, the other one renders, in the same tick. Tab
// changes the tool that the mouse moves; the other one stays where it is.
#include <palpate/io/read_msh.hpp>

#include "scenes.hpp"

namespace live {

TouchScene grasp_scene() {
  TouchScene scene;
  scene.name = "grasp";
  scene.text =
      "Two fingers. Push one against the lobe from above, take the other with Tab, and pinch it from the side. "
      "With key G each holds a pad.";

  scene.mesh = io::read_msh<Tet4>(PALPATE_EXAMPLE_DATA "/organ.msh");
  scene.tissues = {{.region = everywhere, .youngs_modulus = 5e3}};

  // 1. Two tools, with friction: without it a pinched lobe slips out like a wet soap.
  scene.tools = {SphereTool{.radius = 7e-3}, SphereTool{.radius = 7e-3}};
  scene.session.contact.friction = 0.4;
  scene.session.grasp_buttons = 1;
  scene.session.contact.grasp_radius = 12e-3;
  scene.range = {.radius = 12e-3};
  scene.starts = {{0.05, -0.05, 0.05}, {0.05, 0.05, 0.06}};

  // 2. The lobe can be touched on all sides.
  scene.conditions.fix("ligament")
      .fix(where::below({-0.02, 0.0, 0.0}, Vector3::UnitX()))
      .touch(where::above({0.02, 0.0, 0.0}, Vector3::UnitX()))
      .render("surface");

  scene.compositions = {Composition::smoothed, Composition::tet4, Composition::quasi_newton};
  scene.camera = {.target = {0.03, 0.0, 0.015}, .yaw = -1.2, .pitch = 0.6, .distance = 0.42};
  scene.script = R"(
    0.1 move 0.63 0.56
    0.3 press 0.63 0.56
    0.3..0.9 push 8
    1.0 key Tab
    1.0 move 0.59 0.44
    1.2 press 0.59 0.44
    1.2..1.9 push 8
    1.9..2.6 drag 0.62 0.47
    2.7..3.0 push -8
    3.0 release
    3.1 key Tab
    3.1..3.4 push -8
    3.5 release
  )";
  return scene;
}

}  // namespace live
