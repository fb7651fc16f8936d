// Compositions of tools and loops with linear statics.
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/stiffening.hpp>

#include "compositions.hpp"

using namespace palpate;

TEMPLATE_TEST_CASE("linear statics in every composition: no crash, no race, only finite forces", "[extreme][D9]",
                   (HapticFEModel<Smoothed<Tet4>, LinearElastic>),
                   (HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverseFloat>>),
                   (HapticFEModel<Tet4, LinearElastic, SparseCholesky>),
                   (HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>)) {
  compositions::run_all<TestType>();
}
