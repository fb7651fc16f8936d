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

/// Points of the surface below a tool, so that all that it can press is within a radius of one of them.
PointCloud cloud_below(const Case& test, std::size_t tool) {
  PointCloud cloud;
  for (const TestPlace& place : test.places) {
    const auto turn = turn_of(place);
    const int across = tool == 2 ? 1 : 0, along = tool == 0 ? 0 : 1;
    for (int i = -across; i <= across; ++i)
      for (int j = -along; j <= along; ++j)
        cloud.points.push_back(place.point + (tool == 2 ? 0.6 : 1.0) * test.radius * (turn * Vector3(i, j, 0.0)));
  }
  return cloud;
}

}  // namespace

Mesh<Tet4> tetrahedra_of(const Case& test) {
  if (test.facet >= mean_facet(test.body)) return test.body.tetrahedra;
  return refine_near(test.body.tetrahedra, cloud_of(test), {test.facet, 0.5});
}

Presses truth(const Case& test, double finer) {
  ContactParameters contact;
  contact.capacity = 512;
  contact.subfacet_compliance = false;
  Presses presses;
  for (std::size_t tool = 0; tool < tools_of(test); ++tool) {
    const PointCloud below = cloud_below(test, tool);
    where::PointSet touched = where::sphere(below.points.front(), test.radius);
    for (const Vector3& point : below.points) touched = touched || where::sphere(point, test.radius);
    Scene scene;
    scene.fix(test.body.fixed).touch(touched);
    const double edge = std::min(
        test.facet, test.radius / (finer * (tool == 2 ? true_edges_per_radius_of_plates : true_edges_per_radius)));
    HapticFEModel<Tet10, LinearElastic> model(promote<Tet10>(refine_near(test.body.tetrahedra, below, {edge, 0.5})),
                                              scene, materials_of(test));
    presses.push_back(press_tool(model, test, tool, contact));
  }
  return presses;
}

}  // namespace force_error
