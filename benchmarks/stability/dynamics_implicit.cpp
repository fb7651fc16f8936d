// Implicit schemes of the library: a minimised potential per step.
#include "dynamics_schemes.hpp"

#include <palpate/model/implicit_dynamics.hpp>

namespace maps {
namespace {

struct ImplicitMove {
  ImplicitDynamics& motion;
  double dt;

  bool operator()(std::string& said) {
    const StepReport report = motion.step(dt);
    if (!report.taken)
      said = "step not taken";
    else if (!report.newton.converged)
      said = "Newton not converged";
    else if (!report.calm)
      said = "energy grew";
    else if (report.deformation.inverted > 0)
      said = "inverted";
    return report.taken;
  }
  bool holds(EnergyWatch& watch) const { return watch.holds(motion.displacement(), motion.velocity()); }
};

Moved move(const DynamicProblem& problem, double dt, const TimeScheme& scheme) {
  ImplicitDynamics motion(make_deformable_body(neo_hookean(problem), problem.scene), {.scheme = scheme});
  return run(problem, EnergyWatch(make_deformable_body(neo_hookean(problem), problem.scene)), ImplicitMove{motion, dt});
}

}  // namespace

Moved by_implicit_euler(const DynamicProblem& problem, double dt) {
  return move(problem, dt, TimeScheme::implicit_euler());
}
Moved by_newmark(const DynamicProblem& problem, double dt) {
  return move(problem, dt, TimeScheme::newmark());
}

}  // namespace maps
