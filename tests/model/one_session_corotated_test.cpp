// The session program with co-rotational motion without a factor.
#include <palpate/material/corotational.hpp>
#include <palpate/model/moving/implicit.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: co-rotational motion without a factor", "[model][door]") {
  using Model = HapticFEModel<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>;
  one_session::run<Model>();
}
