// Moving tissue that is cut: hexahedra.
#include "composition_lists.hpp"
#include "cut_solvers.hpp"

namespace cross {

using namespace palpate;

void add_cut_moving_hexahedra(Compositions& all) {
  all.push_back(composition<Hex8, StVenantKirchhoff, Cuttable<Implicit<QuasiNewton<float>>>>());
  all.push_back(composition<Hex8, NeoHookeanLogarithmic, Cuttable<Implicit<QuasiNewton<double>>>>());
  all.push_back(composition<Hex8, FibreReinforced<NeoHookean>, Cuttable<Implicit<QuasiNewton<float>>>>());
  all.push_back(composition<Hex20, NeoHookean, Cuttable<Implicit<QuasiNewton<float>>>>());
  all.push_back(composition<Hex20, NeoHookeanIsochoric, Cuttable<Implicit<QuasiNewton<double>>>>());
}

}  // namespace cross
