// A pad of 40 x 40 x 20 mm on a table, constructed in one source and touched in another.
#include "tissue.hpp"

#include <palpate/mesh/generators.hpp>

std::unique_ptr<Tissue> make_tissue() {
  const auto mesh = palpate::box_tet4({0.04, 0.04, 0.02}, {4, 4, 2});
  palpate::Scene scene;
  scene.fix("z0").touch("z1");
  return std::make_unique<Tissue>(mesh, scene, palpate::LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.3});
}
