#include "model/make_any_model.hpp"

namespace test {

// Assembled is the default.
static_assert(
    std::derived_from<SolverTraits<WithAssembly<ConjugateGradient, Assembled>>, SolverTraits<ConjugateGradient>>);

std::unique_ptr<AnyModel> make_conjugate_gradient(const Mesh<Tet4>& mesh, const Scene& scene,
                                                  const Materials& materials, const SetupOptions& options) {
  return std::make_unique<ModelOf<ConjugateGradient>>(mesh, scene, materials, options);
}

std::unique_ptr<AnyModel> make_matrix_free_conjugate_gradient(const Mesh<Tet4>& mesh, const Scene& scene,
                                                              const Materials& materials, const SetupOptions& options) {
  return std::make_unique<ModelOf<WithAssembly<ConjugateGradient, MatrixFree>>>(mesh, scene, materials, options);
}

}  // namespace test
