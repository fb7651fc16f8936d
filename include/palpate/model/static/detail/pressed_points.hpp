// A sphere pressed step by step into points of a tissue, for measurements at set-up.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A point of a surface and the direction against which it is pressed, unit.
struct SurfacePoint {
  Vector3 position = Vector3::Zero();
  Vector3 outward = Vector3::Zero();
};

/// Force along `outward` [N], and HapticServo::indentation [m].
struct PressedPoint {
  double force = 0.0, indentation = 0.0;
};

/// Options of a servo that follows its device exactly; `capacity` of contacts, 0: the default.
ServoOptions rigid_press_options(int capacity);

/// Presses the spheres of a servo, made with `rigid_press_options`, into one point each, all to the same increasing
/// depths [m]; each depth is kept until the force settles. Some hundred ticks. Gives the force on the first sphere.
std::vector<PressedPoint> press_points(HapticServo& servo, double radius, std::span<const SurfacePoint> points,
                                       std::span<const double> depths);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/pressed_points.ipp>
#endif
