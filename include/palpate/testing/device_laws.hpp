// The laws of concepts/haptic_device.hpp, and forces for simulated devices and fakes.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/testing/violation.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

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

/// Access to the internals of a device for the tests. `rendered` returns the force that its motors receive [N]; an
/// adapter of an SDK queries the SDK, or a fake of it. `break_reads(device, true)` makes reads invalid, `false`
/// restores them; if it is empty, that law is not tested. `tolerance` is relative; a device that stores floats needs
/// 1e-6.
template <class Device>
struct DeviceProbe {
  std::function<Vector3(const Device&)> rendered;
  std::function<Vector3(const Device&)> rendered_torque{};  ///< the same [N m]; empty: laws of torque are not tested
  std::function<void(Device&, bool)> break_reads{};
  double tolerance = 1e-12;
};

/// Uses last_force() and, if they exist, last_torque() and unplug(bool).
template <class Device>
DeviceProbe<Device> default_probe() {
  static_assert(
      requires(const Device& device) { {device.last_force()}; },
      "the laws compare commands with the force that the motors receive: give the device a function "
      "`Vector3 last_force() const`, or pass a DeviceProbe");
  DeviceProbe<Device> probe;
  probe.rendered = [](const Device& device) -> Vector3 { return device.last_force(); };
  if constexpr (requires(const Device& device) { device.last_torque(); })
    probe.rendered_torque = [](const Device& device) -> Vector3 { return device.last_torque(); };
  if constexpr (requires(Device & device) { device.unplug(true); })
    probe.break_reads = [](Device& device, bool broken) { device.unplug(broken); };
  return probe;
}

namespace detail {

template <HapticDevice Device>
class DeviceLaws {
 public:
  DeviceLaws(Device& device, const DeviceProbe<Device>& probe)
      : device_(device), probe_(probe), limits_(device.limits()) {}

  Violations run(int reads) {
    sane_limits();
    device_.start();
    static_cast<void>(device_.read());
    saturates();
    if (probe_.rendered_torque) limits_torque();
    if (probe_.break_reads) zero_after_invalid_read();
    survives(reads);
    zero_after_stop();
    return std::move(violations_);
  }

 private:
  Status write(const Vector3& force) { return device_.write(gated(force)); }
  /// With half of the peak torque.
  Status write_with_torque(const Vector3& force) {
    return device_.write(gated(force, Vector3(0.0, 0.0, 0.5 * limits_.peak_torque)));
  }
  Vector3 rendered() const { return probe_.rendered(device_); }
  Vector3 torque() const { return probe_.rendered_torque ? probe_.rendered_torque(device_) : Vector3::Zero(); }
  /// Zero when neither force nor torque is rendered.
  double anything() const { return rendered().norm() + torque().norm(); }

  void sane_limits() {
    expect_above(violations_, "limits are sane", limits_.peak_force, 0.0, "peak force");
    expect_at_most(violations_, "limits are sane", limits_.peak_force, 1e4, "peak force");
    expect_at_most(violations_, "limits are sane", limits_.continuous_force, limits_.peak_force, "continuous force");
    const Vector3 workspace = limits_.workspace_high - limits_.workspace_low;
    expect_above(violations_, "limits are sane", workspace.minCoeff(), 0.0, "workspace");
    expect_at_least(violations_, "limits are sane", limits_.peak_torque, 0.0, "peak torque");
    expect_at_most(violations_, "limits are sane", limits_.peak_torque, 1e4, "peak torque");
    if (limits_.peak_torque > 0.0)
      expect_above(violations_, "limits are sane", limits_.rotational_stiffness, 0.0, "rotational stiffness");
  }

  /// A device without motors for torque renders no torque, whatever is written to it.
  void limits_torque() {
    const double peak = limits_.peak_torque;
    for (const Vector3& direction : {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(1, 2, -3)})
      for (double size : {0.0, 0.5, 0.999, 1.001, 2.0, 1e6}) {
        const Vector3 unit = direction.normalized();
        const Vector3 wanted = unit * (size * (peak > 0.0 ? peak : 1.0));
        const Status status = device_.write(gated(Vector3(0.0, 0.0, 0.0), wanted));
        const Vector3 given = torque();
        const std::string detail = "torque, " + number(size) + " times the peak";
        expect_at_most(violations_, "torque within its peak", given.norm(), peak * (1.0 + probe_.tolerance), detail);
        if (peak == 0.0) continue;
        if (size < 1.0)
          expect_at_most(violations_, "renders what it can", (given - wanted).norm(), probe_.tolerance * peak, detail);
        if (size <= 1.0) continue;
        expect_at_least(violations_, "saturates at the peak", given.norm(), peak * (1.0 - probe_.tolerance), detail);
        expect_at_least(violations_, "keeps the direction", unit.dot(given.normalized()), 1.0 - 1e-12, detail);
        expect_true(violations_, "reports saturation", status.has(StatusFlag::saturated), detail);
      }
  }

  void saturates() {
    const double peak = limits_.peak_force;
    for (const Vector3& direction : {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(1, 2, -3), Vector3(1, 1e-3, 0)})
      for (double size : {0.0, 1e-3, 0.5, 0.999, 1.001, 2.0, 1e6}) {
        const Vector3 unit = direction.normalized();
        const Vector3 wanted = unit * (size * peak);
        const Status status = write(wanted);
        const Vector3 given = rendered();
        const std::string detail = number(size) + " times the peak";
        expect_at_most(violations_, "never above the peak", given.norm(), peak * (1.0 + probe_.tolerance), detail);
        if (size < 1.0)
          expect_at_most(violations_, "renders what it can", (given - wanted).norm(), probe_.tolerance * peak, detail);
        if (size <= 1.0) continue;
        expect_at_least(violations_, "saturates at the peak", given.norm(), peak * (1.0 - probe_.tolerance), detail);
        expect_at_least(violations_, "keeps the direction", unit.dot(given.normalized()), 1.0 - 1e-12, detail);
        expect_true(violations_, "reports saturation", status.has(StatusFlag::saturated), detail);
      }
  }

  void zero_after_invalid_read() {
    const Vector3 force = Vector3(0.0, 0.0, 0.5 * limits_.peak_force);
    write_with_torque(force);
    probe_.break_reads(device_, true);
    const ToolState state = device_.read();
    expect_true(violations_, "reports a failed read", !state.valid);
    const Status status = write_with_torque(force);
    expect_at_most(violations_, "zero after an invalid read", anything(), 0.0);
    expect_true(violations_, "reports disconnection", status.has(StatusFlag::disconnected));
    probe_.break_reads(device_, false);
    const bool restored = device_.read().valid;
    write(force);
    expect_true(violations_, "renders again when reads are valid", restored && rendered().norm() > 0.0);
  }

  void survives(int reads) {
    double time = -infinity;
    std::int64_t bad_states = 0, backwards = 0, future = 0;
    for (int i = 0; i < reads; ++i) {
      const ToolState s = device_.read();
      if (s.valid && !is_sound(s)) ++bad_states;
      if (!(s.time >= time)) ++backwards;
      if (s.now < s.time) ++future;
      time = std::max(time, s.time);
      write(Vector3(0.0, 0.0, 0.1 * limits_.peak_force));
    }
    expect_at_most(violations_, "valid states are finite", static_cast<double>(bad_states), 0.0, "states");
    expect_at_most(violations_, "time does not run backwards", static_cast<double>(backwards), 0.0, "states");
    expect_at_most(violations_, "a pose is not newer than the present time", static_cast<double>(future), 0.0,
                   "states");
    expect_at_most(violations_, "never above the peak", rendered().norm(), limits_.peak_force, "after many reads");
  }

  /// Finite; velocity finite or NaN in all components (not provided); orientation a unit quaternion.
  static bool is_sound(const ToolState& s) {
    const bool no_velocity = std::isnan(s.velocity[0]) && std::isnan(s.velocity[1]) && std::isnan(s.velocity[2]);
    double square = 0.0;
    for (double q : s.orientation) square += q * q;
    return s.position.allFinite() && std::isfinite(s.time) && (no_velocity || s.velocity.allFinite()) &&
           std::abs(square - 1.0) <= 1e-6;
  }

  void zero_after_stop() {
    const Vector3 force = Vector3(0.0, 0.5 * limits_.peak_force, 0.0);
    write_with_torque(force);
    device_.stop();
    expect_at_most(violations_, "zero after stop", anything(), 0.0, "immediately");
    write_with_torque(force);
    expect_at_most(violations_, "zero after stop", anything(), 0.0, "although written to");
    device_.stop();
    expect_at_most(violations_, "zero after stop", anything(), 0.0, "stopped twice");
  }

  Device& device_;
  const DeviceProbe<Device>& probe_;
  DeviceLimits limits_;
  Violations violations_;
};

}  // namespace detail

/// Starts the device, tests the laws, stops it. Nobody may hold the device: forces up to the peak are written. Laws:
/// "limits are sane", "never above the peak", "renders what it can", "saturates at the peak", "keeps the direction",
/// "reports saturation", "reports a failed read", "zero after an invalid read", "reports disconnection", "renders again
/// when reads are valid", "valid states are finite", "time does not run backwards", "a pose is not newer than the
/// present time", "zero after stop"; if the probe returns the torque, "torque within its peak", and the laws of force
/// for torque. The concept checks that nothing throws, and that a device accepts only forces from a gate, which are
/// finite.
template <HapticDevice Device>
Violations device_laws(Device& device, const DeviceProbe<Device>& probe = default_probe<Device>(), int reads = 10'000) {
  return detail::DeviceLaws<Device>(device, probe).run(reads);
}

}}}  // namespace palpate::testing
