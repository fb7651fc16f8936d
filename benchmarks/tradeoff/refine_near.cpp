// Refines a mesh near the spheres.
#include <palpate/mesh/refine_near.hpp>

#include "scene.hpp"

namespace tradeoff {

Mesh<Tet4> refine_near(const PressScene& scene, double edge) {
  PointCloud contacts;
  for (const Sphere& sphere : scene.spheres) contacts.points.push_back(sphere.point);
  return palpate::refine_near(scene.mesh, contacts, {.edge = edge});
}

}  // namespace tradeoff
