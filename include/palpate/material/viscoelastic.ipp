// Definitions of viscoelastic.hpp.
#pragma once

#include <palpate/material/viscoelastic.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double mean_decay(double x) noexcept {
  return x > 0.0 ? -std::expm1(-x) / x : 1.0;
}

}}}  // namespace palpate::detail
