#include <palpate/linear/dense_cholesky.hpp>
#include "model/make_any_model.hpp"

namespace test {

std::unique_ptr<AnyModel> make_condensed_inverse(const Mesh<Tet4>& mesh, const Scene& scene, const Materials& materials,
                                                 const SetupOptions& options) {
  return std::make_unique<ModelOf<Condensed<SelectiveInverse>>>(mesh, scene, materials, options);
}

std::unique_ptr<AnyModel> make_condensed_float(const Mesh<Tet4>& mesh, const Scene& scene, const Materials& materials,
                                               const SetupOptions& options) {
  return std::make_unique<ModelOf<Condensed<SelectiveInverseFloat>>>(mesh, scene, materials, options);
}

std::unique_ptr<AnyModel> make_condensed_cholesky(const Mesh<Tet4>& mesh, const Scene& scene,
                                                  const Materials& materials, const SetupOptions& options) {
  return std::make_unique<ModelOf<Condensed<DenseCholesky>>>(mesh, scene, materials, options);
}

std::unique_ptr<AnyModel> make_condensed_conjugate_gradient(const Mesh<Tet4>& mesh, const Scene& scene,
                                                            const Materials& materials, const SetupOptions& options) {
  return std::make_unique<ModelOf<Condensed<ConjugateGradient>>>(mesh, scene, materials, options);
}

}  // namespace test
