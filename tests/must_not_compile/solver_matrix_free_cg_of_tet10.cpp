// expect: palpate: MatrixFreeCG moves Tet4 with Corotational
#include <palpate/element/tet10.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/implicit.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet10, NeoHookean, Implicit<Newton>>;
#else
using Model = HapticFEModel<Tet10, NeoHookean, Implicit<MatrixFreeCG<BlockJacobi>>>;
#endif

void make(const Mesh<Tet10>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
