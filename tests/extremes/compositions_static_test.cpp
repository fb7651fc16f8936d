// Compositions of tools and loops with linear statics.
#include <palpate/element/smoothed.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/stiffening.hpp>

#include "compositions.hpp"

using namespace palpate;

TEMPLATE_TEST_CASE("linear statics in every composition: no crash, no race, only finite forces", "[extreme][D9]",
                   (HapticFEModel<Smoothed<Tet4>, LinearElastic>),
                   (HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverseFloat>>),
                   (HapticFEModel<Tet4, LinearElastic, SparseCholesky>),
                   (HapticFEModel<Smoothed<Tet4>, LinearElastic, Stiffening<Condensed<SelectiveInverse>>>)) {
  compositions::run_all<TestType>([] {
    using Material = typename TestType::MaterialType;
    const auto mesh = copy_mesh<typename TestType::ElementType>(box_tet4(compositions::size, {5, 5, 3}));
    const Scene scene = Scene().fix("z0").touch("z1");
    if constexpr (requires(Material m) { m.base; })
      return TestType(mesh, scene, Material{{5e3, 0.4, 1000.0}});
    else
      return TestType(mesh, scene, Material{5e3, 0.4, 1000.0});
  });
}
