// A user-defined device: everything a HapticDevice needs, in one class.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/device/render_limits.hpp>

#include <algorithm>

namespace own {

using palpate::DeviceLimits;
using palpate::GatedForce;
using palpate::Status;
using palpate::ToolState;
using palpate::Vector3;

/// A simulated stylus in a hand: a mass pulled to the goal of the hand by a spring, and pushed by the rendered force.
/// Unlike a MockDevice it moves under the rendered force, as a real device would. It has a simulated clock, one
/// millisecond per read.
class HeldStylus {
 public:
  HeldStylus(const Vector3& start, const Vector3& goal) : start_(start), goal_(goal), position_(start) {}

  // --- the five functions of a HapticDevice

  /// Never throws, blocks, allocates or locks. SI units and the clock of the device; a state that could not be read is
  /// marked invalid, not guessed.
  ToolState read() noexcept {
    advance();
    ToolState state;
    state.position = position_;
    state.velocity = velocity_;
    state.time = state.now = time_;
    state.valid = plugged_;
    motors_.read_was(plugged_);  // no force without a valid reading
    return state;
  }

  /// The force comes from a force gate: it is finite and has no jumps. The device is the last stage: it must limit the
  /// force to the peak, and set it to zero unless it is running and readable. RenderLimits does that; send
  /// motors_.force() and torque() to real motors.
  Status write(const GatedForce& force) noexcept { return motors_.render(force); }

  /// From the data sheet, or better from the SDK. `stiffness` bounds the rendered stiffness: the servo uses it to
  /// couple device and proxy. If it is too high, a real device vibrates.
  DeviceLimits limits() const noexcept { return motors_.limits(); }

  /// Opens, checks, calibrates; the only function that may throw.
  void start() noexcept { motors_.start(); }
  void stop() noexcept { motors_.stop(); }

  // --- for tests

  const Vector3& last_force() const noexcept { return motors_.force(); }  ///< [N] rendered now
  void unplug(bool unplugged) noexcept { plugged_ = !unplugged; }
  const Vector3& goal() const noexcept { return goal_; }
  const Vector3& position() const noexcept { return position_; }

 private:
  static constexpr double mass = 0.1;         // [kg]
  static constexpr double stiffness = 150.0;  // [N/m] of the hand
  static constexpr double damping = 7.0;      // [N s/m], nearly critical
  static constexpr double step = 1e-3;        // [s]

  /// One millisecond of the hand: symplectic Euler.
  void advance() noexcept {
    time_ += step;
    const double share = std::min(1.0, time_);  // the hand reaches its goal after a second
    const Vector3 target = start_ + share * (goal_ - start_);
    const Vector3 pull = stiffness * (target - position_) - damping * velocity_;
    velocity_ += step / mass * (pull + motors_.force());
    position_ += step * velocity_;
  }

  Vector3 start_, goal_, position_, velocity_ = Vector3::Zero();
  double time_ = 0.0;
  bool plugged_ = true;
  palpate::RenderLimits motors_{{.peak_force = 3.3,
                                 .continuous_force = 0.88,
                                 .stiffness = 500.0,
                                 .workspace_low = Vector3(-0.1, -0.1, -0.05),
                                 .workspace_high = Vector3(0.1, 0.1, 0.15)}};
};

static_assert(palpate::HapticDevice<HeldStylus>);  // the compiler names what is missing

}  // namespace own
