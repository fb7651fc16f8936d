// expect: palpate: tissue that is cut is Cuttable<Condensed<SelectiveInverse>>
#include <palpate/cut/cuttable.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
#else
using Model = HapticFEModel<Tet4, LinearElastic, Cuttable<SparseCholesky>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
