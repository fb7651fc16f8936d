// Definitions of measured_force_error.hpp.
#pragma once

#include <palpate/model/static/measured_force_error.hpp>

#include <palpate/core/setup_error.hpp>
#include <palpate/model/static/detail/measure_force_error.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ForceErrorOptions measured_force_error(int places) {
  if (places < 1)
    raise(SetupErrorKind::bad_argument, "the force error is to be measured at " + std::to_string(places) + " places",
          "Give one or more; three are typical");
  return {places, &measure_force_error, nullptr};
}

}}  // namespace palpate
