// Options and report of the steps of a co-rotational body.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/detail/requirements.hpp>
#include <palpate/integrator/time_scheme.hpp>
#include <palpate/linear/bounded_conjugate_gradient.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Options of a CorotatedMotion.
struct CorotatedMotionOptions {
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s]
  BoundedSolveParameters solve{};
  int precondition_every = 16;     ///< steps between two updates of the preconditioner
  bool check = true;               ///< compare the energy after a step with that before; one more force evaluation
  int maximum_linearisations = 8;  ///< per step, when the check fails; one suffices except for extreme steps
};

/// The options. Throws bad_argument when a step would do no work, or could add energy.
CorotatedMotionOptions valid(const CorotatedMotionOptions& options);

/// Result of a step.
struct CorotatedStep {
  bool taken = false;          ///< false: the length was not positive, or the result not finite; nothing has changed
  BoundedSolveReport solve{};  ///< the last one
  int linearisations = 0;
  bool energy_bounded = true;       ///< false: the check found more energy than at the start of the step
  double residual = infinity;       ///< residual relative to the largest force of the step; infinite without the check
  DeformationReport deformation{};  ///< at the end; without the check at the predicted state
};

inline CorotatedMotionOptions valid(const CorotatedMotionOptions& o) {
  require_damping(o.mass_damping, o.stiffness_damping);
  if (o.solve.maximum_iterations < 1 || !(o.solve.tolerance >= 0.0 && o.solve.tolerance < 1.0) ||
      o.precondition_every < 1 || o.maximum_linearisations < 1)
    raise(SetupErrorKind::bad_argument, "options with which a step does no work",
          "Give at least one of each, and a tolerance from 0 to less than 1");
  return o;
}

}}  // namespace palpate

