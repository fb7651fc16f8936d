// Two light hands that pinch a thin lobe: do the jaws hold it, and do ticks converge?
#include "presses.hpp"

#include <palpate/device/simulated_device.hpp>
#include <palpate/mesh/generators.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace presses {
namespace {

struct Pinch {
  int unconverged = 0;  ///< ticks of either hand
  bool crossed = false, lost = false;
};

/// The jaws close for a second; then both are still, or swing with this amplitude, for two.
Pinch pinch(Tissue& lobe, Shape shape, double radius, double friction, double amplitude, const Vector3& place) {
  SimulatedOptions upper_options = SimulatedOptions::stylus();
  upper_options.friction = upper_options.encoder_step = 0.0;
  upper_options.hand = SimulatedHand::light();
  SimulatedOptions lower_options = upper_options;
  upper_options.start = place + Vector3(0, 0, 0.006 + radius + 2e-3);
  lower_options.start = place - Vector3(0, 0, radius + 2e-3);
  SimulatedDevice upper(upper_options), lower(lower_options);
  ServoOptions options;
  options.device = upper.limits();
  options.contact.friction = friction;
  const Tool jaw = tool_of(shape, radius);
  HapticServo servo(lobe, ToolList({jaw, jaw}), options);
  upper.start();
  lower.start();
  Pinch result;
  for (int k = 0; k < 3000; ++k) {
    const double t = std::max(0.0, 1e-3 * (k - 1000)), turn = 2.0 * std::numbers::pi * t;
    const Vector3 side = amplitude * Vector3(std::sin(0.5 * turn), std::sin(turn), 0.0);
    const Vector3 down(0.0, 0.0, 10e-3 * std::min(1.0, 1e-3 * k));
    upper.move_hand(upper_options.start - down + side);
    lower.move_hand(lower_options.start + down + side);
    const auto forces = servo.tick(std::array{upper.read(), lower.read()});
    upper.write(forces[0]);
    lower.write(forces[1]);
    const Status status = forces[0].status | forces[1].status;
    result.unconverged += status.has(StatusFlag::solver_not_converged);
    result.crossed = result.crossed || upper.position().z() < lower.position().z();
    result.lost = result.lost || (k > 1500 && (forces[0].force().norm() == 0.0 || forces[1].force().norm() == 0.0));
  }
  return result;
}

}  // namespace

bool pinches(int runs) {
  Scene scene;
  scene.fix("x0").touch("surface");
  Tissue lobe(box_tet4(Vector3(0.04, 0.012, 0.006), {20, 6, 3}), scene, {.youngs_modulus = 2e4, .poisson_ratio = 0.45});
  testing::Random random(19);
  std::printf("\npinches of a lobe of 6 mm by two hands at %d places; unconverged ticks, mean [%%]\n", runs);
  std::printf("%-8s %9s %7s %8s %5s %12s\n", "jaws", "friction", "hands", "crossed", "lost", "unconverged");
  bool right = true;
  for (const Shape shape : {Shape::sphere, Shape::capsule, Shape::box})
    for (const double friction : {0.0, 0.1, 0.3, 0.6, 1.0})
      for (const double amplitude : {0.0, 3e-3}) {
        int crossed = 0, lost = 0, unconverged = 0;
        for (int k = 0; k < runs; ++k) {
          const Vector3 place(random.uniform(0.026, 0.032), random.uniform(0.005, 0.007), 0.0);
          const Pinch p = pinch(lobe, shape, random.uniform(1.2e-3, 2e-3), friction, amplitude, place);
          crossed += p.crossed;
          lost += p.lost;
          unconverged += p.unconverged;
        }
        std::printf("%-8s %9g %7s %8d %5d %12.2f\n", name_of(shape), friction, amplitude > 0.0 ? "moving" : "still",
                    crossed, lost, 100.0 * unconverged / (3000.0 * runs));
        std::fflush(stdout);
        right = right && (friction == 0.0 || (crossed == 0 && lost == 0));
      }
  return right;
}

}  // namespace presses
