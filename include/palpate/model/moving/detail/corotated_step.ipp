// Definitions of corotated_step.hpp.
#pragma once

#include <palpate/model/moving/detail/corotated_step.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/integrator/detail/requirements.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE CorotatedMotionOptions valid(const CorotatedMotionOptions& o) {
  require_damping(o.mass_damping, o.stiffness_damping);
  if (o.solve.maximum_iterations < 1 || !(o.solve.tolerance >= 0.0 && o.solve.tolerance < 1.0) ||
      o.precondition_every < 1 || o.maximum_linearisations < 1)
    raise(SetupErrorKind::bad_argument, "options with which a step does no work",
          "Give at least one of each, and a tolerance from 0 to less than 1");
  return o;
}

}}  // namespace palpate
