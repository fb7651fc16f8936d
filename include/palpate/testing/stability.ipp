// Definitions of stability.hpp.
#pragma once

#include <palpate/testing/stability.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE std::span<const GatedForce> VirtualWall::tick(std::span<const ToolState> tools) noexcept {
  const ToolState& tool = tools.front();
  const double depth = -tool.position[2];
  const Vector3 wanted(0.0, 0.0, one_sided && depth < 0.0 ? 0.0 : stiffness * depth);
  force = gate.apply(wanted, tool.time, tool.time, tool.valid, false);
  return {&force, 1};
}

PALPATE_INLINE double stiffness_limit(double damping, double period, double delay) {
  return damping / (0.5 * period + delay);
}

}}}  // namespace palpate::testing
