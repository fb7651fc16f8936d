// Moving tissue of quadratic tetrahedra: with the other files, every pair of element, law and solver that is allowed.
#include "composition_lists.hpp"
#include "moving_solvers.hpp"

namespace cross {

using namespace palpate;

void add_moving_tet10(Compositions& all) {
  all.push_back(composition<Tet10, LinearElastic, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Tet10, TransverselyIsotropic, Explicit<CentralDifference>>());
  all.push_back(composition<Tet10, Corotational, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Tet10, StVenantKirchhoff, Explicit<CentralDifference>>());
  all.push_back(composition<Tet10, NeoHookean, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Tet10, NeoHookeanLogarithmic, Implicit<Newton>>());
  all.push_back(composition<Tet10, NeoHookeanIsochoric, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Tet10, MooneyRivlin, Explicit<CentralDifference>>());
  all.push_back(composition<Tet10, FibreReinforced<NeoHookean>, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Tet10, Viscoelastic<NeoHookean, 1>, Implicit<Newton>>());
}

}  // namespace cross
