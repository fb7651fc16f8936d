#include "model/make_any_model.hpp"

namespace test {

std::unique_ptr<AnyModel> make_sparse_cholesky(const Mesh<Tet4>& mesh, const Scene& scene, const Materials& materials,
                                               const SetupOptions& options) {
  return std::make_unique<ModelOf<SparseCholesky>>(mesh, scene, materials, options);
}

std::unique_ptr<AnyModel> make_selective_inverse(const Mesh<Tet4>& mesh, const Scene& scene, const Materials& materials,
                                                 const SetupOptions& options) {
  return std::make_unique<ModelOf<SelectiveInverse>>(mesh, scene, materials, options);
}

}  // namespace test
