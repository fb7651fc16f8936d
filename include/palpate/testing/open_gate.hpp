// Forces for simulated devices and fakes.
#pragma once

#include <palpate/haptic/force_gate.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// A gate that passes every finite force up to 1e9 N and torque up to 1e9 N m unchanged, after a first tick of zero.
/// Never use it with a device that a person holds.
inline ForceGate open_gate() {
  ForceLimits limits;
  limits.peak_force = limits.peak_torque = limits.slew_rate = limits.stale_after = 1e9;
  limits.ramp_time = 1e-9;
  limits.period = limits.fade_time = 1.0;
  return ForceGate(limits);
}

/// A force [N] and a torque [N m] that have passed an open gate.
inline GatedForce gated(const Vector3& force, const Vector3& torque = Vector3(0.0, 0.0, 0.0)) {
  ForceGate gate = open_gate();
  gate.apply(force, torque, 0.0, 0.0, true, false);
  return gate.apply(force, torque, 1.0, 1.0, true, false);
}

}}}  // namespace palpate::testing
