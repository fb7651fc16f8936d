// The session program with explicit motion.
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/explicit.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: explicit motion", "[model][door]") {
  using Model = HapticFEModel<Tet4, NeoHookean, Explicit<CentralDifference>>;
  one_session::run<Model>();
}
