// Cube roots of lanes without a function call per number.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Cube root of x >= 1/8, accurate to rounding: Halley's method from (1 + 2x) / (2 + x), whose error is 18 % or less up
/// to x = 8. Each iteration cubes the error. Larger numbers, and NaN, use std::cbrt.
template <class S, int N>
PALPATE_ALWAYS_INLINE Lanes<S, N> cube_root(const Lanes<S, N>& x) noexcept {
  if (!all(x <= Lanes<S, N>(S(8)))) return cbrt(x);
  Lanes<S, N> y = (S(1) + S(2) * x) / (S(2) + x);
  for (int i = 0; i < (sizeof(S) == 4 ? 2 : 3); ++i) {
    const Lanes<S, N> cube = y * y * y;
    y = y * ((cube + S(2) * x) / (S(2) * cube + x));
  }
  return y;
}

}}}  // namespace palpate::detail
