// Definitions of run_haptic_loop.hpp.
#pragma once

#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/run_haptic_loop.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE LoopReport detail::run_loop(std::vector<LoopDevice> devices, const LoopServo& servo,
                                           const LoopOptions& options) {
  const double rate = rate_of(devices);
  return HapticLoop(std::move(devices), servo, rate).run(options);
}

}}  // namespace palpate
