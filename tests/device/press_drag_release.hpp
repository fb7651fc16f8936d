// A tool that presses, drags along a line, and is released.
#pragma once

#include <palpate/device/trajectory.hpp>

namespace test {

using palpate::Trajectory;
using palpate::Vector3;

struct PressDragRelease {
  Vector3 above = Vector3(-0.01, 0.0, 0.02);     ///< start
  Vector3 pressed = Vector3(-0.01, 0.0, -0.01);  ///< end of pressing
  Vector3 dragged = Vector3(0.01, 0.0, -0.01);   ///< end of dragging; released by the distance it was pressed
  double press = 1.0, drag = 2.0, release = 1.0;
};
inline Trajectory press_drag_release(const PressDragRelease& p = {}) {
  return Trajectory({{0.0, p.above},
                     {p.press, p.pressed},
                     {p.press + p.drag, p.dragged},
                     {p.press + p.drag + p.release, p.dragged + (p.above - p.pressed)}});
}

}  // namespace test
