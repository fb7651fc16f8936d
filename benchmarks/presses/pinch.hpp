// Two light hands that pinch a thin part; a test uses it, too.
#pragma once

#include <palpate/device/simulated_device.hpp>
#include <palpate/haptic/haptic_servo.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace presses {

struct PinchedPlace {
  palpate::Vector3 below;  ///< the place on the lower side [m]
  double thickness;        ///< up to the upper side [m]
  double closing = 10e-3;  ///< path of each hand while the jaws close [m]
  double amplitude = 0.0;  ///< of the swing after that [m]; 0: still hands
};

struct Pinch {
  int unconverged = 0;   ///< ticks of either hand, of 3,000
  bool crossed = false;  ///< whether the jaws passed each other
  bool lost = false;     ///< whether a jaw had no force half a second after they closed, or later
};

/// Two equal jaws close for a second, then both hands swing, or are still, for two.
template <class Model>
Pinch pinch(Model& model, const palpate::Tool& jaw, double radius, double friction, const PinchedPlace& place) {
  using namespace palpate;
  SimulatedOptions upper_options = SimulatedOptions::stylus();
  upper_options.friction = upper_options.encoder_step = 0.0;
  upper_options.hand = SimulatedHand::light();
  SimulatedOptions lower_options = upper_options;
  upper_options.start = place.below + Vector3(0, 0, place.thickness + radius + 2e-3);
  lower_options.start = place.below - Vector3(0, 0, radius + 2e-3);
  SimulatedDevice upper(upper_options), lower(lower_options);
  ServoOptions options;
  options.devices = {upper.limits()};
  options.contact.friction = friction;
  HapticServo servo(model, ToolList({jaw, jaw}), options);
  upper.start();
  lower.start();
  Pinch result;
  for (int k = 0; k < 3000; ++k) {
    const double t = std::max(0.0, 1e-3 * (k - 1000)), turn = 2.0 * std::numbers::pi * t;
    const Vector3 side = place.amplitude * Vector3(std::sin(0.5 * turn), std::sin(turn), 0.0);
    const Vector3 down(0.0, 0.0, place.closing * std::min(1.0, 1e-3 * k));
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

}  // namespace presses
