// The session program with motion by a quasi-Newton method.
#include <palpate/element/wrappers.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: motion by a quasi-Newton method", "[model][door]") {
  using Model = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<float>>>;
  one_session::run<Model>();
}
