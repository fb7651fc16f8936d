// The session program with cuttable tissue.
#include <palpate/cut/cuttable.hpp>
#include <palpate/material/linear_elastic.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: cuttable tissue", "[model][door]") {
  using Model = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
  one_session::run<Model>();
}
