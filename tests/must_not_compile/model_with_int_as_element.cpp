// expect: palpate: the first argument of HapticFEModel is an element
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic>;
#else
using Model = HapticFEModel<int, LinearElastic>;
#endif

const SetupReport& report(const Model& model) {
  return model.report();
}
