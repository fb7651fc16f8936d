// A sphere pressed step by step into points of a tissue, for measurements at set-up.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>

#include <cmath>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A point of a surface and the direction against which it is pressed, unit.
struct SurfacePoint {
  Vector3 position = Vector3::Zero();
  Vector3 outward = Vector3::Zero();
};

/// Force along `outward` [N], and TickView::indentation [m].
struct PressedPoint {
  double force = 0.0, indentation = 0.0;
};

/// Options of a servo that follows its device exactly; `capacity` of contacts, 0: the default.
inline ServoOptions rigid_press_options(int capacity) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.contact.capacity = capacity;
  return options;
}

/// Presses the spheres of a servo, made with `rigid_press_options`, into one point each, all to the same increasing
/// depths [m]; each depth is kept until the force settles. Some hundred ticks. Gives the force on the first sphere.
inline std::vector<PressedPoint> press_points(HapticServo& servo, double radius, std::span<const SurfacePoint> points,
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
    return servo.tick_view().contact_force().dot(points.front().outward);
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
    pressed.push_back({force, servo.tick_view().indentation()});
  }
  return pressed;
}

}}}  // namespace palpate::detail
