// The scene: organ, supports, and spheres with position and depth.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/scene.hpp>

#include <string>
#include <vector>

#include "arguments.hpp"
#include "patches.hpp"

namespace tradeoff {

using namespace palpate;

/// Names of groups that every mesh of a scene has.
inline const std::string constrained_group = "tradeoff constrained", near_group = "tradeoff near",
                         wide_group = "tradeoff wide";

/// A sphere, and the line it moves along.
struct Sphere {
  Vector3 touching = Vector3::Zero();  ///< centre at first contact with the surface at rest [m]
  Vector3 towards = Vector3::Zero();   ///< unit vector into the body
  Vector3 point = Vector3::Zero();     ///< point of first contact on the surface [m]
};

/// An organ, its supports, and the spheres pressed into it, all to the same depth.
struct PressScene {
  std::string name;
  Mesh<Tet4> mesh;                           ///< the given mesh, with the groups above
  RegionMaterials<LinearElastic> materials;  ///< at small strain; large strain materials use the same constants
  std::vector<Sphere> spheres;
  double radius = 0.0;              ///< of the spheres [m]
  double small = 0.0, large = 0.0;  ///< depths of the holds [m]
  double speed = 0.02;              ///< speed between the holds [m/s]
  double reach = 0.0;               ///< largest distance of a contact from `point` [m]
  std::string remark;               ///< which parts were chosen because none were given

  /// The scene with supports, touchable at the group `touched`.
  Scene scene(const std::string& touched) const {
    Scene s;
    s.fix(constrained_group).touch(touched);
    return s;
  }
  std::vector<Vector3> centres(double depth) const {
    std::vector<Vector3> c;
    for (const Sphere& b : spheres) c.push_back(b.touching + depth * b.towards);
    return c;
  }
};

/// palpate: a sphere pressed into the middle of the touchable group, in the organ over its stiff lesion; retract: a
/// sphere lifts the thin lobe of the organ; grasp: two spheres pinch it. Other meshes: palpate only. Throws SetupError.
PressScene make_scene(const SceneOptions& options);

/// The same on a mesh that is no file, with these parts and spheres of this radius [m]; 0: chosen.
PressScene make_scene(Mesh<Tet4> mesh, const Patches& patches, double radius, const SceneOptions& options);

/// A sphere that moves along the surface normal at a point of the surface.
Sphere sphere_along_normal(const Mesh<Tet4>& mesh, const Vector3& point, double radius);

/// The same body with shorter edges near the spheres: `edge` at the contact points, increasing with distance.
/// Nodes keep their ids; new ones are appended. Longest-edge bisection (Rivara 1984).
Mesh<Tet4> refine_near(const PressScene& scene, double edge);

/// Triangles of the boundary of a mesh.
std::vector<std::array<NodeId, 3>> boundary_triangles(const Mesh<Tet4>& mesh);

/// Volume of the body whose boundary is displaced by u, 3 per node [m^3].
double volume_of(const Mesh<Tet4>& mesh, const std::vector<std::array<NodeId, 3>>& boundary, const VectorX& u);

}  // namespace tradeoff
