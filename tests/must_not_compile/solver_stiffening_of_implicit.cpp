// expect: palpate: Stiffening scales a static solver
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/static/stiffening.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Tet4, LinearElastic, Stiffening<SparseCholesky>>;
#else
using Model = HapticFEModel<Tet4, LinearElastic, Stiffening<Implicit<Newton>>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
