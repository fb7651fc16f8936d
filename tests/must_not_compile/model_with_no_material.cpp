// expect: palpate: the second argument of HapticFEModel is a material
// It has a stiffness, but neither a density nor a check.
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

struct Spring {
  double stiffness = 1.0;
};

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic>;
#else
using Model = HapticFEModel<Tet4, Spring>;
#endif

const SetupReport& report(const Model& model) {
  return model.report();
}
