// Schemes that are compiled in separate files, and the bodies they move.
#pragma once

#include "dynamics.hpp"

#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>

namespace maps {

inline HyperelasticBody<Tet4, NeoHookean> neo_hookean(const DynamicProblem& p) {
  return make_hyperelastic_body<Tet4, NeoHookean>(p.mesh, std::vector<NeoHookean>{{p.young, p.nu, p.density}});
}
inline HyperelasticBody<Tet4, Corotational> corotational(const DynamicProblem& p) {
  return make_hyperelastic_body<Tet4, Corotational>(p.mesh, std::vector<Corotational>{{p.young, p.nu, p.density}});
}

/// Steps of a motion that returns a report; `converged` extracts the convergence from the report.
template <class Motion, class Converged>
struct ReportedSteps {
  Motion& motion;
  double dt;
  Converged converged;

  bool operator()(std::string& remark) {
    const auto report = motion.step(dt);
    if (!report.taken)
      remark = "step not taken";
    else if (!converged(report))
      remark = "not converged";
    else if (!report.energy_bounded)
      remark = "energy grew";
    else if (report.deformation.inverted > 0)
      remark = "inverted";
    return report.taken;
  }
  bool holds(EnergyWatch& watch) const { return watch.holds(motion.displacement(), motion.velocity()); }
};

Moved by_central_difference(const DynamicProblem& problem, double dt);
Moved by_semi_implicit_euler(const DynamicProblem& problem, double dt);
Moved by_implicit_euler(const DynamicProblem& problem, double dt);
Moved by_newmark(const DynamicProblem& problem, double dt);
Moved by_corotated_euler(const DynamicProblem& problem, double dt);
Moved by_corotated_newmark(const DynamicProblem& problem, double dt);

}  // namespace maps
