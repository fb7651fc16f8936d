// expect: palpate: this solver is for statics at small strain
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
#else
using Model = HapticFEModel<Tet4, NeoHookean, Condensed<SelectiveInverse>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
