// A device in the test's hand.
#pragma once

#include <palpate/concepts/haptic_device.hpp>

#include <functional>

namespace test {

/// Its state is `state`, or that of `path` in a tick, at 1 kHz. It keeps the last force.
struct Handle {
  palpate::ToolState read() noexcept {
    if (path) state = path(tick);
    state.time = state.now = 1e-3 * tick++;
    return state;
  }
  palpate::Status write(const palpate::GatedForce& f) noexcept {
    force = f;
    ++writes;
    return {};
  }
  palpate::DeviceLimits limits() const noexcept { return device; }
  void start() { ++starts; }
  void stop() noexcept { ++stops; }

  palpate::ToolState state;
  std::function<palpate::ToolState(int)> path;
  palpate::DeviceLimits device{.peak_force = 50.0,
                               .continuous_force = 50.0,
                               .stiffness = 4000.0,
                               .peak_torque = 5.0,
                               .rotational_stiffness = 200.0};
  palpate::GatedForce force;
  int tick = 0, writes = 0, starts = 0, stops = 0;
};

}  // namespace test
