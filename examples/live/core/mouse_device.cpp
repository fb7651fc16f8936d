#include "mouse_device.hpp"

#include <chrono>

namespace live {

namespace {

/// As a common stylus. A mouse has no motors that get hot: the continuous force is the peak.
DeviceLimits limits_of_a_mouse() {
  DeviceLimits limits;
  limits.continuous_force = limits.peak_force;
  limits.workspace_low = Vector3::Constant(-1.0);
  limits.workspace_high = Vector3::Constant(1.0);
  limits.rate = MouseDevice::rate;
  return limits;
}

}  // namespace

MouseDevice::MouseDevice(const Vector3& start, DeviceClock clock)
    : position_(start), clock_(clock), rendered_(limits_of_a_mouse()) {
  target_.position = start;
}

ToolState MouseDevice::read() noexcept {
  for (PointerTarget next; targets_.pop(next);) {
    target_ = next;
    if (!next.set_there) continue;
    position_ = next.position;
    velocity_.setZero();
  }
  follow();
  ToolState state;
  state.position = position_;
  state.velocity = velocity_;
  state.buttons = target_.buttons;
  state.valid = target_.plugged;
  state.time = state.now = now();  // the pose of a mouse that rests is not old
  ++reads_;
  rendered_.read_was(state.valid);
  return state;
}

double MouseDevice::now() const noexcept {
  if (clock_ == DeviceClock::simulated) return static_cast<double>(reads_) / rate;
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void MouseDevice::follow() noexcept {
  constexpr double h = 1.0 / rate;
  velocity_ += h * quickness * (quickness * (target_.position - position_) - 2.0 * velocity_);
  if (const double speed = velocity_.norm(); speed > most_speed) velocity_ *= most_speed / speed;
  position_ += h * velocity_;
}

}  // namespace live
