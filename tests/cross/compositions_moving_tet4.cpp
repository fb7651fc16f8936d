// Moving tissue of linear tetrahedra: with the other files, every pair of element, law and solver that is allowed.
#include "composition_lists.hpp"
#include "moving_solvers.hpp"

namespace cross {

using namespace palpate;

void add_moving_tet4(Compositions& all) {
  all.push_back(composition<Tet4, LinearElastic, Explicit<CentralDifference>>());
  all.push_back(composition<Tet4, Orthotropic, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Tet4, Corotational, Implicit<Newton>>());
  all.push_back(composition<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>());
  all.push_back(composition<Tet4, StVenantKirchhoff, Implicit<QuasiNewton<double>>>());
  all.push_back(composition<Tet4, NeoHookean, Explicit<CentralDifference>>());
  all.push_back(composition<Tet4, NeoHookeanLogarithmic, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Tet4, NeoHookeanIsochoric, Implicit<Newton>>());
  all.push_back(composition<Tet4, MooneyRivlin, Implicit<QuasiNewton<double>>>());
  all.push_back(composition<Tet4, FibreReinforced<NeoHookean>, Explicit<CentralDifference>>());
  all.push_back(composition<Tet4, Viscoelastic<NeoHookean, 1>, Implicit<QuasiNewton<float>>>());
}

}  // namespace cross
