// The session program with implicit motion by Newton's method.
#include <palpate/element/tet10.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/moving/implicit.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: implicit motion by Newton's method", "[model][door]") {
  using Model = HapticFEModel<Tet10, NeoHookean, Implicit<Newton>>;
  one_session::run<Model>();
}
