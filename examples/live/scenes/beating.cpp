// Scene: an organ that beats.
//
// Explicit dynamics: no matrix and no factorisation, but inertia, waves, and loads that change with time. A soft sphere
// is squeezed seventy times a minute; a finger on it is lifted by every beat.
#include <palpate/mesh/generators.hpp>

#include "scenes.hpp"

#include <cmath>
#include <numbers>

namespace live {

namespace {

constexpr double rate = 1.2;       // [1/s] beats
constexpr double squeeze = 500.0;  // [Pa]

/// A quick squeeze in the first third of a beat, then rest.
double pressure_at(double time) {
  const double share = rate * time - std::floor(rate * time);
  return share < 0.35 ? squeeze * std::pow(std::sin(std::numbers::pi * share / 0.35), 2) : 0.0;
}

Scene conditions_at(double time) {
  return Scene()
      .fix(where::below({0.0, 0.0, -0.028}))
      .pressure("surface", pressure_at(time))
      .touch(where::above({0.0, 0.0, -0.015}))
      .render("surface");
}

}  // namespace

TouchScene beating_scene() {
  TouchScene scene;
  scene.name = "beating";
  scene.text = "Explicit dynamics at 70 beats a minute. Lay the finger on it.";

  // A sphere of 40 mm, compressible as an organ that empties.
  scene.mesh = sphere_tet4(0.04, 6);
  scene.tissues = {{.region = everywhere, .youngs_modulus = 6e3, .poisson_ratio = 0.3}};

  scene.tools = {SphereTool{.radius = 7e-3}};
  scene.starts = {{0.0, -0.03, 0.07}};

  scene.conditions = conditions_at(0.0);
  scene.conditions_at = conditions_at;
  scene.compositions = {Composition::beating};

  scene.camera = {.target = {0.0, 0.0, 0.0}, .yaw = -1.6, .pitch = 0.5, .distance = 0.24};
  scene.script = R"(
    0.1 move 0.50 0.35
    0.3 press 0.50 0.35
    0.3..0.8 push 4
    0.8..2.6 drag 0.58 0.40
    2.6..2.9 push -4
    3.0 release
  )";
  return scene;
}

}  // namespace live
