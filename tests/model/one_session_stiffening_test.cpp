// The session program with stiffening tissue.
#include <palpate/element/smoothed.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/static/stiffening.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: stiffening tissue", "[model][door]") {
  using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>;
  one_session::run<Model>();
}
