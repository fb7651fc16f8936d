// A device of one's own: everything a HapticDevice needs, in one struct.
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

/// A stylus in a hand, simulated: a mass pulled by the hand's spring to where the hand wants to be, and pushed by the
/// force that is rendered. So unlike a MockDevice it feels: pushed back, it moves back, as a mouse or a real arm would.
/// Time is its own, one millisecond per read.
class HeldStylus {
 public:
  HeldStylus(const Vector3& start, const Vector3& goal) : start_(start), goal_(goal), position_(start) {}

  // --- the five functions of a HapticDevice

  /// Never throws, blocks, allocates or locks. SI units and the clock of the device; a state that could not be had is
  /// marked invalid, not guessed.
  ToolState read() noexcept {
    advance();
    ToolState state;
    state.position = position_;
    state.velocity = velocity_;
    state.time = time_;
    state.valid = plugged_;
    motors_.read_was(plugged_);  // who cannot read must not push
    return state;
  }

  /// The force comes from a force gate: it is finite and has no jumps. The device is the last to touch it: within the
  /// peak, and zero unless running and readable. RenderLimits does that; real motors get motors_.force() and torque().
  Status write(const GatedForce& force) noexcept { return motors_.render(force); }

  /// From the data sheet, or better from the SDK. `stiffness` bounds what is felt: the servo couples tool and tissue
  /// with it. Too high and a real device buzzes.
  DeviceLimits limits() const noexcept { return motors_.limits(); }

  /// Opens, checks, calibrates; the only one that may throw.
  void start() noexcept { motors_.start(); }
  void stop() noexcept { motors_.stop(); }

  // --- for tests

  const Vector3& last_force() const noexcept { return motors_.force(); }  ///< [N] what is rendered now
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
    const double share = std::min(1.0, time_);  // the hand takes a second to get there
    const Vector3 wanted = start_ + share * (goal_ - start_);
    const Vector3 pull = stiffness * (wanted - position_) - damping * velocity_;
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

static_assert(palpate::HapticDevice<HeldStylus>);  // says at once what is missing

}  // namespace own
