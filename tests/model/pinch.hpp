// Two spheres that pinch a part of a body.
#pragma once

#include <palpate/contact/tools.hpp>
#include <palpate/haptic/haptic_servo.hpp>

#include <algorithm>
#include <array>

namespace test {

/// Normal force [N] on the upper one of two spheres that pinch a part along z, each pressed to `depth` from its side.
template <class Model>
double pinched_force(Model& model, double radius, const palpate::Vector3& above, const palpate::Vector3& below,
                     double depth) {
  using namespace palpate;
  ServoOptions rigid;
  rigid.coupling_stiffness = infinity;
  rigid.contact.capacity = 400;
  HapticServo servo(model, {SphereTool{radius}, SphereTool{radius}}, rigid);
  std::array<ToolState, 2> states;
  for (int i = 0; i <= 60; ++i) {
    const double out = radius - depth * std::min(1.0, i / 20.0);
    for (ToolState& state : states) state.time += 1e-3;
    states[0].position = above + out * Vector3::UnitZ();
    states[1].position = below - out * Vector3::UnitZ();
    servo.tick(states);
  }
  return servo.tick_view().contact_force(0).z();
}

}  // namespace test
