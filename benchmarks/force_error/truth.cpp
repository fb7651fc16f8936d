#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>

#include "press.hpp"

namespace force_error {

RegionMaterials<LinearElastic> materials_of(const Case& test) {
  RegionMaterials<LinearElastic> materials;
  for (const std::string& region : test.body.tetrahedra.region_names) {
    LinearElastic material{.youngs_modulus = 5e3, .poisson_ratio = test.poisson_ratio, .density = 1060.0};
    if (region == "lesion") material.youngs_modulus *= test.body.stiff_region;
    materials.push_back({region, material});
  }
  return materials;
}

Forces truth(const Case& test, double edges_per_radius) {
  PointCloud cloud;
  where::PointSet touched = where::sphere(test.places.front().point, 0.8 * test.radius);
  for (const TestPlace& place : test.places) {
    cloud.points.push_back(place.point);
    touched = touched || where::sphere(place.point, 0.8 * test.radius);
  }
  Scene scene;
  scene.fix(test.body.fixed).touch(touched);
  const Mesh<Tet10> mesh =
      promote<Tet10>(refine_near(test.body.tetrahedra, cloud, {test.radius / edges_per_radius, 0.5}));
  HapticFEModel<Tet10, LinearElastic> model(mesh, scene, materials_of(test));
  Forces forces(test.places.size());
  press(model, test, 512,
        [&](std::size_t i, std::size_t d, const HapticServo&, double force) { forces[i][d] = force; });
  return forces;
}

}  // namespace force_error
