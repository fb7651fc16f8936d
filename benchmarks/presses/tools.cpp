// Tools and bodies of all parts.
#include "presses.hpp"

#include <palpate/mesh/generators.hpp>

namespace presses {

Tool tool_of(Shape shape, double radius) {
  if (shape == Shape::sphere) return SphereTool{.radius = radius};
  if (shape == Shape::capsule) return CapsuleTool(radius, 2.0 * radius, {0, 1, 0});
  return ConvexTool::box({3.0 * radius, 2.0 * radius, 2.0 * radius}, 0.25 * radius);
}

const char* name_of(Shape shape) noexcept {
  return shape == Shape::sphere ? "sphere" : shape == Shape::capsule ? "capsule" : "box";
}

ForceLimits open_gate() noexcept {
  ForceLimits limits;
  limits.peak_force = 1e6;
  limits.slew_rate = 1e9;
  limits.ramp_time = 1e-9;
  return limits;
}

Tissue block(const Vector3& size, std::array<int, 3> cells) {
  Scene scene;
  scene.fix("z0").touch("surface");
  return Tissue(box_tet4(size, cells, BoxSplit::six), scene, {.youngs_modulus = 5e3, .poisson_ratio = 0.45});
}

}  // namespace presses
