// expect: palpate: moving tissue that is cut needs a hyperelastic material without memory
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/material/viscoelastic.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet10, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>>;
#else
using Model = HapticFEModel<Tet10, Viscoelastic<NeoHookean, 1>, Cuttable<Implicit<QuasiNewton<>>>>;
#endif

void make(const Mesh<Tet10>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
