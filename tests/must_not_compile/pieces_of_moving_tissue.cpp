// expect: pieces of tissue that moves are added by the thread that draws
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/cut/moving_pieces.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Organ = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
#else
using Organ = HapticFEModel<Tet4, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>>;
#endif

void take(MovingPieces& pieces, Organ& organ) {
  pieces.take_from(organ);
}
