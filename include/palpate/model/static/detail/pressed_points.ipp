// Definitions of pressed_points.hpp.
#pragma once

#include <palpate/model/static/detail/pressed_points.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ServoOptions rigid_press_options(int capacity) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.contact.capacity = capacity;
  return options;
}

PALPATE_INLINE std::vector<PressedPoint> press_points(HapticServo& servo, double radius,
                                                      std::span<const SurfacePoint> points,
                                                      std::span<const double> depths) {
  constexpr int steps = 8, patience = 40;  // ticks to a depth, and most at it
  constexpr double settled = 1e-4;
  servo.reset();
  std::vector<ToolState> states(points.size());
  const auto force_at = [&](double depth) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      states[i].time += 1e-3;
      states[i].position = points[i].position + (radius - depth) * points[i].outward;
    }
    servo.tick(states);
    return servo.contact_force().dot(points.front().outward);
  };
  std::vector<PressedPoint> pressed;
  double depth = -0.1 * radius;
  force_at(depth);
  for (const double goal : depths) {
    const double from = depth;
    double force = 0.0, before = 0.0;
    for (int i = 1; i <= steps; ++i) force = force_at(depth = from + (goal - from) * i / steps);
    for (int i = 0; i < patience && !(i > 1 && std::abs(force - before) <= settled * std::abs(force)); ++i) {
      before = force;
      force = force_at(goal);
    }
    pressed.push_back({force, servo.indentation()});
  }
  return pressed;
}

}}  // namespace palpate
