// expect: the condensed stiffness is dense: choose Condensed<SelectiveInverse>
#include <palpate/element/tet4.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Policy = Condensed<DenseCholesky>;
#else
using Policy = Condensed<SparseCholesky>;
#endif

using Model = HapticFEModel<Tet4, LinearElastic, Policy>;
Policy policy;
const SetupReport& report(const Model& model) {
  return model.report();
}
