// Two light hands that pinch a lobe and swing it.
#include <palpate/contact/convex_tool.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace palpate;

namespace {

using Lobe = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

struct Pinch {
  int unconverged = 0;   ///< ticks of either hand, of 3,000
  bool crossed = false;  ///< whether the jaws passed each other
};

/// The jaws close for a second, then swing for two with an amplitude of 3 mm.
Pinch pinch(Lobe& lobe, const Tool& jaw, double radius, double friction) {
  SimulatedOptions upper_options = SimulatedOptions::stylus();
  upper_options.friction = upper_options.encoder_step = 0.0;
  upper_options.hand = SimulatedHand::light();
  SimulatedOptions lower_options = upper_options;
  upper_options.start = Vector3(0.03, 0.006, 0.006 + radius + 2e-3);
  lower_options.start = Vector3(0.03, 0.006, -radius - 2e-3);
  SimulatedDevice upper(upper_options), lower(lower_options);
  ServoOptions options;
  options.device = upper.limits();
  options.contact.friction = friction;
  HapticServo servo(lobe, ToolList({jaw, jaw}), options);
  upper.start();
  lower.start();
  Pinch result;
  for (int k = 0; k < 3000; ++k) {
    const double t = std::max(0.0, 1e-3 * (k - 1000)), turn = 2.0 * std::numbers::pi * t;
    const Vector3 side = 3e-3 * Vector3(std::sin(0.5 * turn), std::sin(turn), 0.0);
    const Vector3 down(0.0, 0.0, 14e-3 * std::min(1.0, 1e-3 * k));
    upper.move_hand(upper_options.start - down + side);
    lower.move_hand(lower_options.start + down + side);
    const auto forces = servo.tick(std::array{upper.read(), lower.read()});
    upper.write(forces[0]);
    lower.write(forces[1]);
    const Status status = forces[0].status | forces[1].status;
    result.unconverged += status.has(StatusFlag::solver_not_converged);
    result.crossed = result.crossed || upper.position().z() < lower.position().z();
  }
  return result;
}

}  // namespace

TEST_CASE("jaws with friction that swing a lobe hold it, and few ticks do not converge", "[haptic][servo][pinch]") {
  Scene scene;
  scene.fix("x0").touch("surface");
  Lobe lobe(box_tet4(Vector3(0.04, 0.012, 0.006), {20, 6, 3}), scene,
            LinearElastic{.youngs_modulus = 2e4, .poisson_ratio = 0.45});
  const double radius = 1.5e-3;
  int unconverged = 0;
  for (const double friction : {0.1, 1.0})
    for (const Tool& jaw :
         {Tool(CapsuleTool(radius, 4e-3, {0, 1, 0})), Tool(ConvexTool::box({10e-3, 6e-3, 3e-3}, radius))}) {
      const Pinch result = pinch(lobe, jaw, radius, friction);
      CHECK_FALSE(result.crossed);
      unconverged += result.unconverged;
    }
  CHECK(unconverged <= 100);  // of 12,000
}
