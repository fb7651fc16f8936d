// The session text on tissue that is cut.
#include <palpate/cut/cuttable.hpp>
#include <palpate/material/linear_elastic.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session text: tissue that is cut", "[model][door]") {
  using Model = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
  one_session::run<Model>();
}
