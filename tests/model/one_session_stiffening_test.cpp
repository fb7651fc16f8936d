// The session program with stiffening tissue.
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/static/stiffening.hpp>

#include "one_session.hpp"

using namespace palpate;

TEST_CASE("one session program: stiffening tissue", "[model][door]") {
  using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>;
  one_session::run<Model>();
}

TEST_CASE("stiffening tissue, whose ratios follow the forces of its servo, is refused to a second one",
          "[model][refused]") {
  using Model = HapticFEModel<Tet4, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>;
  Model model(one_session::block(), one_session::constrained_block(), one_session::material<LinearElastic>());
  {
    const HapticServo servo(model, SphereTool{one_session::radius});
    CHECK_REFUSED(SetupErrorKind::unsupported, HapticServo(model, SphereTool{one_session::radius}));
  }
  CHECK_NOTHROW(HapticServo(model, SphereTool{one_session::radius}));
}
