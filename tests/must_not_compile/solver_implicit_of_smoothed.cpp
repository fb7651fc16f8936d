// expect: palpate: Smoothed and MeanDilatation average small strains
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/st_venant_kirchhoff.hpp>
#include <palpate/model/moving/implicit.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, StVenantKirchhoff, Implicit<Newton>>;
#else
using Model = HapticFEModel<Smoothed<Tet4>, StVenantKirchhoff, Implicit<Newton>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
