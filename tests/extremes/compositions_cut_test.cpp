// Compositions of tools and loops with tissue that is cut.
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>

#include "compositions.hpp"

using namespace palpate;

TEMPLATE_TEST_CASE("tissue that is cut in every composition: no crash, no race, only finite forces", "[extreme][D9]",
                   (HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>),
                   (HapticFEModel<Smoothed<Tet4>, NeoHookean, Cuttable<Implicit<QuasiNewton<float>>>>),
                   (HapticFEModel<Tet4, NeoHookean, Cuttable<Implicit<QuasiNewton<double>>>>)) {
  compositions::run_all<TestType>();
}
