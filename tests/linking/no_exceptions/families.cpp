// A tissue of every family of solvers, touched in a session and cut where it can be; compiled without exceptions and
// RTTI, with every public header (no_exceptions.cmake writes the list).
#include <palpate/own_types.hpp>

#include "all_headers.hpp"

#if defined(__cpp_exceptions) || defined(__cpp_rtti)
#error "compile this without exceptions and without RTTI"
#endif

using namespace palpate;

/// What a program does with a tissue: set-up, background work, a session, results.
template <class Tissue, class Material>
double use(const Material& material) {
  const auto mesh = box_tet4({0.04, 0.04, 0.02}, {2, 2, 1});
  Scene scene;
  scene.fix("z0").touch("z1");
  Tissue tissue(mesh, scene, material);
  if constexpr (requires { tissue.background_work(); }) BackgroundWorker worker(tissue);
  if constexpr (requires { tissue.cut(std::vector<Index>{0}); }) tissue.cut(std::vector<Index>{0});
  MockDevice device(trajectory::poke({.from = {0.02, 0.02, 0.026}, .to = {0.02, 0.02, 0.022}}));
  HapticSession session(device, tissue, SphereTool{.radius = 5e-3});
  tissue.set_gravity({0.0, 0.0, -9.81});
  return session.run({.duration = 0.01}).peak_force;
}

int main() {
  const LinearElastic linear{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0};
  const NeoHookean soft{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0};
  const Corotational corotated{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0};
  double sum = use<HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>>(linear);
  sum += use<HapticFEModel<Tet4, LinearElastic, Condensed<ConjugateGradient>>>(linear);
  sum += use<HapticFEModel<Tet4, LinearElastic, WithAssembly<ConjugateGradient, MatrixFree>>>(linear);
  sum += use<HapticFEModel<Tet4, LinearElastic, SparseCholesky>>(linear);
  sum += use<HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>>(linear);
  sum += use<HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<float>>>>(soft);
  sum += use<HapticFEModel<Smoothed<Tet4>, NeoHookean, Cuttable<Implicit<QuasiNewton<float>>>>>(soft);
  sum += use<HapticFEModel<Tet4, NeoHookean, Implicit<Newton>>>(soft);
  sum += use<HapticFEModel<Tet4, Corotational, Implicit<MatrixFreeCG<BlockJacobi>>>>(corotated);
  sum += use<HapticFEModel<Tet4, NeoHookean, Explicit<CentralDifference>>>(soft);
  return sum >= 0.0 ? 0 : 1;
}
