// Definitions of moving_model.hpp.
#pragma once

#include <palpate/model/moving/moving_model.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void require_step(double step) {
  if (!(step > 0.0 && step < infinity))
    raise(SetupErrorKind::bad_argument, "a step of " + number(step) + " s", "Give a positive time in seconds");
}

}}}  // namespace palpate::detail
