// expect: palpate: a cut changes the averages of smoothed elements
#include <palpate/cut/cuttable.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
#else
using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
