// expect: palpate: explicit steps do not support viscoelastic materials
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/model/moving/explicit.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic, Explicit<CentralDifference>>;
#else
using Model = HapticFEModel<Tet4, Viscoelastic<LinearElastic, 1>, Explicit<CentralDifference>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
