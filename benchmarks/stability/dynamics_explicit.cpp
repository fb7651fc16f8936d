// Explicit schemes of the library.
#include "dynamics_schemes.hpp"

#include <palpate/assembly/batched_tetrahedra.hpp>
#include <palpate/assembly/element_frequency.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/integrator/explicit_schemes.hpp>

namespace maps {
namespace {

template <class SchemeOf>
struct ExplicitStep {
  ExplicitMotion<BatchedTetrahedra<NeoHookean>, SchemeOf>& motion;
  double dt;

  bool operator()(std::string& remark) {
    const Status status = motion.step(dt);
    for (int bit = 0; bit < status_flag_count; ++bit)
      if ((status.bits() >> bit & 1u) != 0) remark += (remark.empty() ? "" : " ") + std::string(status_flag_name(bit));
    return !status.has(StatusFlag::step_refused);
  }
  bool holds(EnergyWatch& watch) const { return watch.holds(motion.state().displacement, motion.state().velocity); }
};

template <class SchemeOf>
Moved move(const DynamicProblem& problem, double dt) {
  const auto body = neo_hookean(problem);
  EnergyWatch watch(make_deformable_body(neo_hookean(problem), problem.scene));
  ExplicitMotion<BatchedTetrahedra<NeoHookean>, SchemeOf> motion(BatchedTetrahedra<NeoHookean>(body),
                                                                 watch.body().lumped, watch.body().conditions.free_dofs,
                                                                 element_frequency_bound(body.rest));
  motion.load() = watch.body().load;
  return run(problem, std::move(watch), ExplicitStep<SchemeOf>{motion, dt});
}

}  // namespace

Moved by_central_difference(const DynamicProblem& problem, double dt) {
  return move<CentralDifference>(problem, dt);
}
Moved by_semi_implicit_euler(const DynamicProblem& problem, double dt) {
  return move<SemiImplicitEuler>(problem, dt);
}

}  // namespace maps
