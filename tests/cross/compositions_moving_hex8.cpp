// Moving tissue of linear hexahedra: with the other files, every pair of element, law and solver that is allowed.
#include "composition_lists.hpp"
#include "moving_solvers.hpp"

namespace cross {

using namespace palpate;

void add_moving_hex8(Compositions& all) {
  all.push_back(composition<Hex8, TransverselyIsotropic, Implicit<Newton>>());
  all.push_back(composition<Hex8, Corotational, Explicit<CentralDifference>>());
  all.push_back(composition<Hex8, StVenantKirchhoff, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Hex8, NeoHookean, Implicit<Newton>>());
  all.push_back(composition<Hex8, NeoHookeanLogarithmic, Implicit<QuasiNewton<double>>>());
  all.push_back(composition<Hex8, NeoHookeanIsochoric, Explicit<CentralDifference>>());
  all.push_back(composition<Hex8, MooneyRivlin, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<Hex8, FibreReinforced<NeoHookean>, Implicit<Newton>>());
  all.push_back(composition<Hex8, Viscoelastic<NeoHookean, 1>, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<MeanDilatation<Hex8>, LinearElastic, Implicit<Newton>>());
  all.push_back(composition<MeanDilatation<Hex8>, TransverselyIsotropic, Explicit<SemiImplicitEuler>>());
  all.push_back(composition<MeanDilatation<Hex8>, Orthotropic, Explicit<CentralDifference>>());
}

}  // namespace cross
