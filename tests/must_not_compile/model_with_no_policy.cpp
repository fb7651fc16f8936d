// expect: palpate: the third argument of HapticFEModel is a solver
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic, SparseCholesky>;
#else
using Model = HapticFEModel<Tet4, LinearElastic, MatrixFree>;  // an assembly, not a solver
#endif

const SetupReport& report(const Model& model) {
  return model.report();
}
