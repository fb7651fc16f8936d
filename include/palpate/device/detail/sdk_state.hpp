// Common helpers of device adapters that convert the data of an SDK into a ToolState.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/rigid_motion.hpp>

#include <chrono>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Seconds of the steady clock since construction.
class SteadyStamp {
 public:
  double now() const noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - origin_).count();
  }

 private:
  std::chrono::steady_clock::time_point origin_ = std::chrono::steady_clock::now();
};

/// Sets the orientation of a state from a rotation matrix; an invalid matrix leaves it unchanged.
inline void orient(ToolState& state, const Matrix3& rotation) noexcept {
  if (!((rotation.transpose() * rotation - Matrix3::Identity()).norm() < 1e-3)) return;
  const Quaternion<double> q = quaternion_of(rotation);
  state.orientation = {q.w, q.x, q.y, q.z};
}

}}}  // namespace palpate::detail
