// A tool that presses, closes on what presses, and lifts.
#include "presses.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace presses {
namespace {

struct Grasp {
  bool missed = true;    ///< does not pull after the lift
  double jump = 0.0;     ///< change of the force by the button
  double chatter = 0.0;  ///< largest change per tick at rest after the lift
  int unconverged = 0;   ///< ticks
};

Grasp grasp(Tissue& tissue, double top, Shape shape, double radius, double friction, const Vector3& place) {
  ServoOptions options;
  options.contact.friction = friction;
  options.grasp_buttons = 1;
  options.force_limits = open_gate();
  HapticServo servo(tissue, tool_of(shape, radius), options);
  ToolState state;
  Grasp result;
  const auto tick = [&](double height) {
    state.time += 1e-3;
    state.position = place + (top + height) * Vector3::UnitZ();
    result.unconverged += servo.tick(state).status.has(StatusFlag::solver_not_converged);
    return servo.tick_view().contact_force();
  };
  const double pressed = 0.75 * radius, lifted = 1.5 * radius;
  Vector3 force = Vector3::Zero();
  for (int k = 0; k <= 500; ++k) force = tick(1.2 * radius + (pressed - 1.2 * radius) * k / 500.0);
  for (int k = 0; k < 100; ++k) force = tick(pressed);
  state.buttons = 1;
  const Vector3 grasped = tick(pressed);
  result.jump = (grasped - force).norm() / force.norm();
  for (int k = 0; k <= 800; ++k) force = tick(pressed + (lifted - pressed) * k / 800.0);
  result.missed = !(force.z() < 0.0);
  for (int k = 0; k < 300; ++k) {
    const Vector3 now = tick(lifted);
    if (k > 200) result.chatter = larger(result.chatter, (now - force).norm() / now.norm());
    force = now;
  }
  return result;
}

}  // namespace

bool grasps(int runs) {
  constexpr double top = 0.03;
  testing::Random random(5);
  std::printf("\ngrasps by the button, %d of each; most change of the force by the button and per tick at rest [%%]\n",
              runs);
  std::printf("%-8s %7s %8s %8s %12s\n", "tool", "missed", "button", "at rest", "unconverged");
  bool right = true;
  for (const Shape shape : {Shape::sphere, Shape::capsule, Shape::box}) {
    int missed = 0, unconverged = 0;
    double jump = 0.0, chatter = 0.0;
    for (int k = 0; k < runs; ++k) {
      const int cells = 6 << k % 2;
      Tissue tissue = block({0.05, 0.05, top}, {cells, cells, cells * 3 / 5});
      const Vector3 place(random.uniform(0.018, 0.032), random.uniform(0.018, 0.032), 0.0);
      const Grasp g = grasp(tissue, top, shape, random.uniform(3e-3, 6e-3), 0.25 * (k % 5), place);
      missed += g.missed;
      unconverged += g.unconverged;
      jump = larger(jump, g.jump);
      chatter = larger(chatter, g.chatter);
    }
    std::printf("%-8s %7d %8.2f %8.3f %12d\n", name_of(shape), missed, 100.0 * jump, 100.0 * chatter, unconverged);
    std::fflush(stdout);
    right = right && missed == 0 && jump < 0.1 && chatter < 1e-3;
  }
  return right;
}

}  // namespace presses
