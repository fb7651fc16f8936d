#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>

#include <algorithm>

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

Tool tool_of(std::size_t number, double radius) {
  if (number == 1) return CapsuleTool(radius, radius, {0, 1, 0});
  if (number == 2) return ConvexTool::box({2.0 * radius, 2.0 * radius, radius}, 0.5 * radius);
  return SphereTool{radius};
}

double reach_of(std::size_t number, double radius) {
  return number == 2 ? 0.5 * radius : radius;
}

namespace {

PointCloud cloud_of(const Case& test) {
  PointCloud cloud;
  for (const TestPlace& place : test.places) cloud.points.push_back(place.point);
  return cloud;
}

}  // namespace

Mesh<Tet4> tetrahedra_of(const Case& test) {
  if (test.facet >= mean_facet(test.body)) return test.body.tetrahedra;
  return refine_near(test.body.tetrahedra, cloud_of(test), {test.facet, 0.5});
}

Presses truth(const Case& test, double finer) {
  const double reach = (test.all_tools ? 1.25 : 1.0) * test.radius;
  where::PointSet touched = where::sphere(test.places.front().point, reach);
  for (const TestPlace& place : test.places) touched = touched || where::sphere(place.point, reach);
  Scene scene;
  scene.fix(test.body.fixed).touch(touched);
  const double per_radius = finer * (test.all_tools ? true_edges_per_radius_of_plates : true_edges_per_radius);
  const double edge = std::min(test.facet, test.radius / per_radius);
  HapticFEModel<Tet10, LinearElastic> model(
      promote<Tet10>(refine_near(test.body.tetrahedra, cloud_of(test), {edge, 0.5})), scene, materials_of(test));
  ContactParameters contact;
  contact.capacity = 512;
  contact.subfacet_compliance = false;
  return press_all(model, test, contact);
}

}  // namespace force_error
