// Moving tissue of quadratic hexahedra: with the other files, every pair of element, law and solver that is allowed.
#include "composition_lists.hpp"
#include "moving_solvers.hpp"

namespace cross {

using namespace palpate;

void add_moving_hex20(Compositions& all) {
  all.push_back(composition<Hex20, Orthotropic, Implicit<Newton>>());
  all.push_back(composition<Hex20, Corotational, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Hex20, StVenantKirchhoff, Implicit<Newton>>());
  all.push_back(composition<Hex20, NeoHookean, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Hex20, NeoHookeanLogarithmic, Explicit<CentralDifference>>());
  all.push_back(composition<Hex20, NeoHookeanIsochoric, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Hex20, MooneyRivlin, Implicit<Newton>>());
  all.push_back(composition<Hex20, FibreReinforced<NeoHookean>, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Hex20, Viscoelastic<NeoHookean, 1>, Implicit<QuasiNewton<double>>>());
}

}  // namespace cross
