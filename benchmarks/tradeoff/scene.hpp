// What is pressed, by what, where and how deep.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/scene.hpp>

#include <string>
#include <vector>

namespace tradeoff {

using namespace palpate;

/// Names of groups that every mesh of a scene has.
inline const std::string constrained_group = "tradeoff held", near_group = "tradeoff near",
                         wide_group = "tradeoff wide";

/// A sphere, and the line it moves along.
struct Sphere {
  Vector3 touching = Vector3::Zero();  ///< centre where it just touches the surface at rest [m]
  Vector3 towards = Vector3::Zero();   ///< unit, into the body
  Vector3 point = Vector3::Zero();     ///< of the surface, where it touches first [m]
};

/// An organ, how it is held, and the spheres pressed into it, all to the same depth.
struct PressScene {
  std::string name;
  Mesh<Tet4> mesh;                           ///< as given, with the groups above
  RegionMaterials<LinearElastic> materials;  ///< at small strain; laws of large strain take the same constants
  std::vector<Sphere> spheres;
  double radius = 0.0;              ///< of the spheres [m]
  double small = 0.0, large = 0.0;  ///< depths at which they rest [m]
  double speed = 0.02;              ///< between them [m/s]
  double reach = 0.0;               ///< no contact is farther from `point` than that [m]

  /// Held, and touchable where `touched` (a group) says.
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

/// What the command line may say about a scene.
struct SceneOptions {
  std::string mesh, constrained, touched;  ///< file and groups; empty: the organ that comes with palpate and its groups
  std::string kind = "palpate";     ///< palpate, retract or grasp
  double youngs_modulus = 5e3, poisson_ratio = 0.45, density = 1060.0;
};

/// palpate: a sphere pressed into the middle of the touchable group, in the organ over its stiff lesion; retract: a
/// sphere lifts the thin lobe of the organ; grasp: two spheres pinch it. Other meshes: palpate only. Throws SetupError.
PressScene make_scene(const SceneOptions& options);

/// The sphere that comes along the normal of the surface at one of its points.
Sphere sphere_along_normal(const Mesh<Tet4>& mesh, const Vector3& point, double radius);

/// The same body with shorter edges near the spheres: `edge` where they press, growing with the distance. Nodes keep
/// their ids, new ones follow. Longest-edge bisection (Rivara 1984).
Mesh<Tet4> refine_near(const PressScene& scene, double edge);

/// Triangles of the boundary of the mesh as given.
std::vector<std::array<NodeId, 3>> boundary_triangles(const Mesh<Tet4>& mesh);

/// Volume of the body whose boundary is displaced by u, 3 per node [m^3].
double volume_of(const Mesh<Tet4>& mesh, const std::vector<std::array<NodeId, 3>>& boundary, const VectorX& u);

}  // namespace tradeoff
