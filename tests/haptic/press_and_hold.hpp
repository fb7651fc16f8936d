// A sphere pressed into moving tissue and kept there; both rates are simulated.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/moving/moving_tissue.hpp>

#include "catch.hpp"

#include <algorithm>
#include <utility>

namespace test {

using namespace palpate;

/// Contact force [N] on a sphere of `radius` [m] that was pressed 4 mm into the surface at `top` and kept there, and
/// the status of the last 100 ticks of 1 ms.
inline std::pair<Vector3, Status> press_and_hold(MovingTissue& tissue, const Vector3& top, double radius, int ticks) {
  ServoOptions options;
  options.devices = {{.peak_force = 20.0, .stiffness = 2000.0}};
  HapticServo servo(tissue, SphereTool{.radius = radius}, options);
  Status status;
  double next = 0.0;
  for (int k = 0; k < ticks; ++k) {
    if (1e-3 * k >= next - 1e-9) {
      tissue.advance();
      next += tissue.step();
    }
    ToolState s;
    s.time = 1e-3 * k;
    s.position = top + Vector3(0.0, 0.0, radius - std::min(0.004, 0.02 * s.time));
    const GatedForce force = servo.tick(s);
    REQUIRE(servo.tick_view().contact_force().allFinite());
    REQUIRE(force.force().allFinite());
    if (k >= ticks - 100) status |= force.status;
  }
  return {servo.tick_view().contact_force(), status};
}

}  // namespace test
