// Random presses, slides, pinches and grasps with the composition that scenes should use.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/testing/random.hpp>

#include <string>
#include <vector>

namespace presses {

using namespace palpate;

using Tissue = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

/// Tools with a radius [m]: a sphere, a capsule whose axis is four radii long, a box of 3 x 2 x 2 radii.
enum class Shape { sphere, capsule, box };
Tool tool_of(Shape shape, double radius);
const char* name_of(Shape shape) noexcept;

/// The larger of two numbers; NaN stays.
inline double larger(double a, double b) noexcept {
  return b <= a ? a : b;
}

/// Limits that let every force pass.
ForceLimits open_gate() noexcept;

/// A block on a rigid base; all of its surface can be touched.
Tissue block(const Vector3& size, std::array<int, 3> cells);

// Each prints a table of what may be wrong with the forces of `runs` presses, and returns whether what must not happen
// did not: see main.cpp.

/// Presses to three radii on organ, blocks, lobe and cut block, with tilts up to 40 degrees.
bool deep_presses(Shape shape, double friction, int runs);
/// Slides without friction, in, along, out and back, on blocks with facets from 2.5 to 10 mm.
bool slides(int runs);
/// Two hands that pinch a lobe, still and moving, friction 0 to 1.
bool pinches(int runs);
/// A tool that presses, grasps by its button and lifts.
bool grasps(int runs);

}  // namespace presses
