// Definitions of serendipity.hpp.
#pragma once

#include <palpate/element/detail/serendipity.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace serendipity {

PALPATE_INLINE double factor(double s, double x) noexcept {
  return s == 0.0 ? 1.0 - x * x : 0.5 * (1.0 + s * x);
}

PALPATE_INLINE double factor_derivative(double s, double x) noexcept {
  return s == 0.0 ? -2.0 * x : 0.5 * s;
}

}}}  // namespace palpate::serendipity
