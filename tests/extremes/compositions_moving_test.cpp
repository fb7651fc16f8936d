// Compositions of tools and loops with tissue that moves.
#include <palpate/element/wrappers.hpp>
#include <palpate/material/corotational.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/explicit.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "compositions.hpp"

using namespace palpate;

TEMPLATE_TEST_CASE("tissue that moves in every composition: no crash, no race, only finite forces", "[extreme][D9]",
                   (HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<float>>>),
                   (HapticFEModel<Tet4, NeoHookean, Implicit<Newton>>),
                   (HapticFEModel<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>),
                   (HapticFEModel<Tet4, NeoHookean, Explicit<CentralDifference>>)) {
  compositions::run_all<TestType>();
}
