// Co-rotated steps of the library: one linearisation per step, no factor.
#include "dynamics_schemes.hpp"

#include <palpate/model/corotated_motion.hpp>

namespace maps {
namespace {

using Motion = CorotatedMotion<LinearElastic, float>;

struct CorotatedMove {
  Motion& motion;
  double dt;

  bool operator()(std::string& said) {
    const CorotatedStep report = motion.step(dt);
    if (!report.taken)
      said = "step not taken";
    else if (!report.solve.converged)
      said = "solve not converged";
    else if (!report.calm)
      said = "not calm";
    else if (report.deformation.inverted > 0)
      said = "inverted";
    return report.taken;
  }
  bool holds(EnergyWatch& watch) const { return watch.holds(motion.displacement(), motion.velocity()); }
};

Moved move(const DynamicProblem& problem, double dt, const TimeScheme& scheme) {
  Motion motion(corotational(problem), problem.scene, {.scheme = scheme});
  return run(problem, EnergyWatch(make_deformable_body(corotational(problem), problem.scene)),
             CorotatedMove{motion, dt});
}

}  // namespace

Moved by_corotated_euler(const DynamicProblem& problem, double dt) {
  return move(problem, dt, TimeScheme::implicit_euler());
}
Moved by_corotated_newmark(const DynamicProblem& problem, double dt) {
  return move(problem, dt, TimeScheme::newmark());
}

std::vector<Scheme> our_schemes() {
  return {{"CentralDifference", true, by_central_difference}, {"SemiImplicitEuler", true, by_semi_implicit_euler},
          {"implicit Euler", true, by_implicit_euler},        {"Newmark", true, by_newmark},
          {"co-rotated, Euler", true, by_corotated_euler},    {"co-rotated, Newmark", true, by_corotated_newmark}};
}

}  // namespace maps
