// Implicit schemes of the library: a minimised potential per step.
#include "dynamics_schemes.hpp"

#include <palpate/model/moving/implicit_dynamics.hpp>

namespace maps {
namespace {

Moved move(const DynamicProblem& problem, double dt, const TimeScheme& scheme) {
  ImplicitDynamics motion(make_deformable_body(neo_hookean(problem), problem.scene), {.scheme = scheme});
  return run(problem, EnergyWatch(make_deformable_body(neo_hookean(problem), problem.scene)),
             ReportedSteps{motion, dt, [](const StepReport& report) { return report.newton.converged; }});
}

}  // namespace

Moved by_implicit_euler(const DynamicProblem& problem, double dt) {
  return move(problem, dt, TimeScheme::implicit_euler());
}
Moved by_newmark(const DynamicProblem& problem, double dt) {
  return move(problem, dt, TimeScheme::newmark());
}

}  // namespace maps
