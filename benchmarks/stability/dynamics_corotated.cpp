// Co-rotated steps of the library: one linearisation per step, no factorisation.
#include "dynamics_schemes.hpp"

#include <palpate/model/moving/detail/corotated_motion.hpp>

namespace maps {
namespace {

using Motion = detail::CorotatedMotion<float>;

Moved move(const DynamicProblem& problem, double dt, const TimeScheme& scheme) {
  Motion motion(corotational(problem), problem.scene, {.scheme = scheme});
  return run(problem, EnergyWatch(make_deformable_body(corotational(problem), problem.scene)),
             ReportedSteps{motion, dt, [](const detail::CorotatedStep& report) { return report.solve.converged; }});
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
