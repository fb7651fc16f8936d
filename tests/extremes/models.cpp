#include "model/make_any_model.hpp"

#include "catch.hpp"

namespace test {

std::unique_ptr<AnyModel> make_model(PolicyName policy, const Mesh<Tet4>& mesh, const Scene& scene,
                                     const Materials& materials, const SetupOptions& options) {
  if (policy == PolicyName::sparse_cholesky)
    return std::make_unique<ModelOf<SparseCholesky>>(mesh, scene, materials, options);
  if (policy == PolicyName::conjugate_gradient)
    return std::make_unique<ModelOf<ConjugateGradient>>(mesh, scene, materials, options);
  if (policy == PolicyName::condensed_inverse)
    return std::make_unique<ModelOf<Condensed<SelectiveInverse>>>(mesh, scene, materials, options);
  if (policy == PolicyName::condensed_float)
    return std::make_unique<ModelOf<Condensed<SelectiveInverseFloat>>>(mesh, scene, materials, options);
  if (policy == PolicyName::condensed_conjugate_gradient)
    return std::make_unique<ModelOf<Condensed<ConjugateGradient>>>(mesh, scene, materials, options);
  FAIL("this executable does not have " << name(policy));
  return nullptr;
}

}  // namespace test
