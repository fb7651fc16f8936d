// What the steps of a co-rotated body may choose, and what they report.
#pragma once

#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/integrator/time_scheme.hpp>
#include <palpate/linear/bounded_conjugate_gradient.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What a CorotatedMotion may choose.
struct CorotatedMotionOptions {
  TimeScheme scheme = TimeScheme::implicit_euler();
  double mass_damping = 0.0;       ///< Rayleigh's alpha [1/s]
  double stiffness_damping = 0.0;  ///< Rayleigh's beta [s]
  BoundedSolveParameters solve{};
  int precondition_every = 16;     ///< steps between two looks at the diagonal of the stiffness
  bool check = true;               ///< hold the energy after a step against that before it: one more sweep of forces
  int maximum_linearisations = 8;  ///< of a step whose check fails; one is enough for all but wild ones
};

/// What a step did.
struct CorotatedStep {
  bool taken = false;  ///< false: the step was not a positive number, or nothing finite came of it; nothing has changed
  BoundedSolveReport solve{};  ///< the last one
  int linearisations = 0;
  bool energy_bounded = true;       ///< false: checked, and the energy is still above that at the start of the step
  double residual = infinity;       ///< force left over, of the largest force of the step; infinite without the check
  DeformationReport deformation{};  ///< at the end; without the check where it coasts to
};

}}  // namespace palpate
