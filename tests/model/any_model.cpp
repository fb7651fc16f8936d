#include "model/any_model.hpp"

#include "catch.hpp"

namespace test {

using Maker = std::unique_ptr<AnyModel>(const Mesh<Tet4>&, const Scene&, const Materials&, const SetupOptions&);

// In policies_*.cpp: they are slow to compile.
Maker make_sparse_cholesky, make_conjugate_gradient, make_matrix_free_conjugate_gradient, make_selective_inverse,
    make_condensed_inverse, make_condensed_float, make_condensed_cholesky, make_condensed_conjugate_gradient;

std::unique_ptr<AnyModel> make_model(PolicyName policy, const Mesh<Tet4>& mesh, const Scene& scene,
                                     const Materials& materials, const SetupOptions& options) {
  constexpr std::array<Maker*, all_policies.size()> makers{
      &make_sparse_cholesky,    &make_conjugate_gradient,          &make_matrix_free_conjugate_gradient,
      &make_selective_inverse,  &make_condensed_inverse,           &make_condensed_float,
      &make_condensed_cholesky, &make_condensed_conjugate_gradient};
  return makers[static_cast<std::size_t>(policy)](mesh, scene, materials, options);
}

}  // namespace test
