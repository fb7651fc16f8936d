// Moving tissue that is cut: tetrahedra.
#include "composition_lists.hpp"
#include "cut_solvers.hpp"

namespace cross {

using namespace palpate;

void add_cut_moving_tetrahedra(Compositions& all) {
  all.push_back(composition<Tet4, Corotational, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Tet4, NeoHookean, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Tet4, NeoHookeanLogarithmic, Cuttable<Implicit<QuasiNewton<float>>>>());
  all.push_back(composition<Tet4, MooneyRivlin, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Smoothed<Tet4>, StVenantKirchhoff, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Smoothed<Tet4>, NeoHookeanIsochoric, Cuttable<Implicit<QuasiNewton<float>>>>());
  all.push_back(composition<Smoothed<Tet4>, FibreReinforced<NeoHookean>, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Tet10, Corotational, Cuttable<Implicit<QuasiNewton<float>>>>());
  all.push_back(composition<Tet10, NeoHookean, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Tet10, MooneyRivlin, Cuttable<Implicit<QuasiNewton<float>>>>());
}

}  // namespace cross
