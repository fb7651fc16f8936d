// Presses a sphere of 5 mm radius 2 mm into the pad: the force must point straight up and be of a plausible size.
#include "tissue.hpp"

#include <palpate/haptic/haptic_servo.hpp>

#include <cstdio>

int main() {
  const auto tissue = make_tissue();
  palpate::HapticServo servo(*tissue, palpate::SphereTool{.radius = 5e-3});
  palpate::Vector3 force = palpate::Vector3::Zero();
  for (int i = 0; i <= 1000; ++i) {
    palpate::ToolState tool;
    tool.time = 1e-3 * i;
    tool.position = {0.02, 0.02, 0.026 - 3e-6 * i};  // from 1 mm above to 2 mm into the surface
    force = servo.tick({&tool, 1})[0].force();
    if (i == 0 && force.norm() != 0.0) return 2;  // no contact yet
  }
  std::printf("%.6f %.6f %.6f N, touchable vertices: %lld\n", force[0], force[1], force[2],
              static_cast<long long>(tissue->report().touchable_vertices));
  const bool right = force.allFinite() && force[2] > 0.03 && force[2] < 1.0 && force.head<2>().norm() < 0.1 * force[2];
  return right && tissue->report().touchable_vertices == 25 ? 0 : 1;
}
