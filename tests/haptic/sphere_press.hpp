// A sphere with a rigid coupling, pressed into tissue and kept there.
#pragma once

#include "contact/servo_session.hpp"

#include <algorithm>

namespace test {

struct SpherePress {
  double force;   ///< against the press [N]
  Status status;  ///< of the last tick
};

/// Presses a sphere of `radius` [m] along the unit vector `direction` until it is `depth` [m] below the point `at` of
/// the surface, in 100 ticks of 1 ms, and holds it for 20.
template <class Model>
SpherePress press_sphere(Model& model, double radius, const Vector3& at, const Vector3& direction, double depth) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = open_gate();
  HapticServo servo(model, SphereTool{.radius = radius}, options);
  SpherePress result{};
  for (int k = 0; k < 120; ++k) {
    ToolState s;
    s.position = at + (depth * std::min(1.0, k / 100.0) - radius) * direction;
    s.time = 1e-3 * k;
    result.status = servo.tick(s).status;
  }
  result.force = -servo.tick_view().contact_force().dot(direction);
  return result;
}

}  // namespace test
