// Definitions of stability.hpp.
#pragma once

#include <palpate/testing/stability.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE std::span<const ToolForce> VirtualWall::tick(std::span<const ToolState> tools) noexcept {
  const double depth = -tools.front().position[2];
  force.force = Vector3(0.0, 0.0, one_sided && depth < 0.0 ? 0.0 : stiffness * depth);
  return {&force, 1};
}

PALPATE_INLINE double stiffness_limit(double damping, double period, double delay) {
  return damping / (0.5 * period + delay);
}

}}}  // namespace palpate::testing
