// expect: palpate: QuasiNewton moves hyperelastic materials
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Model = HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>>;
#else
using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Implicit<QuasiNewton<>>>;
#endif

void make(const Mesh<Tet4>& mesh, const Scene& scene) {
  const Model model(mesh, scene, Model::MaterialType{});
}
