// Definitions of mock_device.hpp.
#pragma once

#include <palpate/device/mock_device.hpp>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double steady_seconds() noexcept {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
PALPATE_INLINE void sleep_for(double seconds) noexcept {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

PALPATE_INLINE double checked_rate(double rate) {
  if (!(rate > 0.0 && std::isfinite(rate)))
    raise(SetupErrorKind::bad_argument, "the rate of a mock device is " + number(rate) + " Hz", "Give 1000");
  return rate;
}
PALPATE_INLINE bool hits(const DeviceFault& fault, std::uint64_t read) noexcept {
  return read >= fault.first && read - fault.first < fault.count;
}
PALPATE_INLINE void corrupt(ToolState& state, const DeviceFault& fault) noexcept {
  if (fault.kind == DeviceFault::Kind::invalid_read) state.valid = false;
  if (fault.kind == DeviceFault::Kind::nan_position) state.position[1] = std::numeric_limits<double>::quiet_NaN();
  if (fault.kind == DeviceFault::Kind::infinite_position) state.position[1] = infinity;
  if (fault.kind == DeviceFault::Kind::teleport) state.position += fault.offset;
}

}}}  // namespace palpate::detail
