// The session program with linear statics.
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: linear statics", "[model][door]") {
  using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic>;
  one_session::run<Model>();
}
