// What the tick needs from the processor: denormals flushed to zero inside a scope.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/platform.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Flushes denormals to zero (FTZ and DAZ) while it lives and restores the thread's mode afterwards. A body coming to
/// rest decays into denormals, which cost 20 to 130 times a normal multiplication. Does nothing on processors it does
/// not know.
class FlushDenormals {
 public:
  FlushDenormals() noexcept : saved_(platform::float_mode()) {
    platform::set_float_mode(saved_ | platform::flush_denormals);
  }
  ~FlushDenormals() { platform::set_float_mode(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  std::uint64_t saved_;
};

}}  // namespace palpate
