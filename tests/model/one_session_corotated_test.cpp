// The session text on co-rotated motion without a factor.
#include <palpate/material/corotational.hpp>
#include <palpate/model/moving/implicit.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session text: co-rotated motion without a factor", "[model][door]") {
  using Model = HapticFEModel<Tet4, Corotational<LinearElastic>, Implicit<MatrixFreeCG<BlockJacobi>>>;
  one_session::run<Model>();
}
