// Presses places of a model.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <cmath>

#include "cell.hpp"

namespace force_error {

/// Presses every place to every depth, and calls use(place, depth, servo, force) when the force has settled.
template <class Tissue, class Use>
void press(Tissue& tissue, const Case& test, int capacity, Use use) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
  options.contact.capacity = capacity;
  HapticServo servo(tissue, SphereTool{test.radius}, options);
  for (std::size_t i = 0; i < test.places.size(); ++i) {
    const auto& [point, outward] = test.places[i];
    servo.reset();
    ToolState state;
    const auto force_at = [&](double depth) {
      state.time += 1e-3;
      state.position = point + (test.radius - depth) * outward;
      servo.tick(state);
      return servo.contact_force().dot(outward);
    };
    double depth = -0.1 * test.radius;
    force_at(depth);
    for (std::size_t d = 0; d < depths.size(); ++d) {
      const double goal = depths[d] * test.radius, from = depth;
      double force = 0.0, before = 0.0;
      for (int k = 1; k <= 10; ++k) force = force_at(depth = from + (goal - from) * k / 10.0);
      for (int k = 0; k < 60 && !(k > 1 && std::abs(force - before) <= 1e-5 * std::abs(force)); ++k) {
        before = force;
        force = force_at(goal);
      }
      use(i, d, servo, force);
    }
  }
}

}  // namespace force_error
