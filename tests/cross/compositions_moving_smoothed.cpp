// Moving tissue of smoothed tetrahedra: with the other files, every pair of element, law and solver that is allowed.
#include "composition_lists.hpp"
#include "moving_solvers.hpp"

namespace cross {

using namespace palpate;

void add_moving_smoothed(Compositions& all) {
  all.push_back(composition<Smoothed<Tet4>, Corotational, Implicit<QuasiNewton<double>>>());
  all.push_back(composition<Smoothed<Tet4>, StVenantKirchhoff, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<double>>>());
  all.push_back(composition<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Smoothed<Tet4>, NeoHookeanLogarithmic, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Smoothed<Tet4>, NeoHookeanIsochoric, Implicit<QuasiNewton<double>>>());
  all.push_back(composition<Smoothed<Tet4>, MooneyRivlin, Implicit<QuasiNewton<float>>>());
  all.push_back(composition<Smoothed<Tet4>, FibreReinforced<NeoHookean>, Implicit<QuasiNewton<double>>>());
}

}  // namespace cross
