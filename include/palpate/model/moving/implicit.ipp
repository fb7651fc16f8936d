// Definitions of implicit.hpp.
#pragma once

#include <palpate/model/moving/implicit.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE PreparedMotion SolverTraits<Implicit<Newton<SparseCholesky>>>::prepare(DeformableBody body,
                                                                                      bool is_linear,
                                                                                      const Parameters& p,
                                                                                      const SetupLimits& limits) {
  PreparedMotion made;
  made.accepts_initial_strains = is_linear;
  made.large_strain = !is_linear;
  made.start = VectorX::Zero(body.load.size());
  if (p.settle) {
    Equilibrium statics(std::move(body), limits);
    made.start = detail::settled(statics);
    body = std::move(statics).release();
  }
  const DynamicsParameters parameters{p.scheme, p.mass_damping, p.stiffness_damping, p.mass, p.newton};
  made.motion = std::make_unique<ImplicitMotion>(std::move(body), parameters, limits);
  return made;
}

}}  // namespace palpate
