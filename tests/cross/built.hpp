// What a scene means: mesh, conditions and paths of the tools.
#pragma once

#include "scene.hpp"

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>

#include <Eigen/Geometry>

#include <functional>
#include <string>
#include <vector>

namespace cross {

using palpate::Matrix3;
using palpate::Vector3;

/// The same scene seen differently: the force must not depend on it, except by the factors given here.
struct Change {
  Matrix3 linear = Matrix3::Identity();  ///< of the coordinates: a rotation or a reflection
  Vector3 shift = Vector3::Zero();       ///< [m], afterwards
  double scale = 1.0;                    ///< of all lengths; forces at the same modulus are scale^2 times as large
  bool renumbered = false;               ///< nodes and elements in another order
  bool split = false;                    ///< in two regions of one material
  bool gravity = false;                  ///< a body load as gravity of the same force
  double pause = 0.0;                    ///< [s] that the second phase of the paths takes longer, at its beginning

  Vector3 operator()(const Vector3& x) const { return scale * (linear * x) + shift; }
  /// Of a direction or force.
  Vector3 direction(const Vector3& d) const { return linear * d; }
};

/// Mesh and conditions: either of tetrahedra or, for elements of hexahedra, of these. Groups "support" (nodes that are
/// fixed or moved), "end" and "touchable" and regions "first" and, unless there is one only, "second".
struct Body {
  palpate::Mesh<palpate::Tet4> tetrahedra;
  palpate::Mesh<palpate::Hex8> hexahedra;
  palpate::Scene conditions;
  std::function<palpate::Scene(double)> conditions_at{};  ///< with a part of Scene::support_travels; empty: none
  std::vector<double> moduli;                             ///< Young's modulus of every region [Pa]
  std::string division;  ///< word of the regions as made: one that leaves a region empty is replaced
  double density = 0.0;  ///< in the change's units, so that the motion takes the same time
  double size = 0.0;     ///< largest extent [m]
};

/// Whether an element is a hexahedron.
bool is_hexahedral(const Scene& scene);
/// Whether a body can be made of hexahedra.
bool has_hexahedra(const std::string& body);
/// Whether the body of a scene has no box of hexahedra as its reference shape.
inline bool is_round(const Scene& scene) {
  return !has_hexahedra(scene.body);
}

Body make_body(const Scene& scene, const Change& change = {});

/// A point of the touchable surface of the body as its formula gives it, before facets and jitter, and its outward
/// normal.
struct Place {
  Vector3 point, normal, along;  ///< along: a unit tangent
};
/// Whether the body has another side that can be touched.
bool has_opposite(const Scene& scene);
/// u, v in 0 ... 1 of the touchable part; `opposite` the point on the other side, where there is one.
Place place_of(const Scene& scene, double u, double v, bool opposite);

/// The tools, in the change's units and axes. The edge of a blade does not rotate with its device: it follows the pose
/// of the tissue here.
palpate::ToolList tools_of(const Scene& scene, const Change& change = {},
                           const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// The state of a tool in a tick, world frame. The path has three phases: it approaches and goes in to its depth (0 to
/// 0.45 of the ticks), stays (hold, press: to 0.7), and comes out again (to 1); slide, twist, leap, lost and frozen
/// (the device repeats a pose) change the second phase. It is smooth and slow enough that a tissue without inertia
/// follows.
palpate::ToolState state_of(const Scene& scene, std::size_t tool, int tick, const Eigen::Isometry3d& pose,
                            const Change& change = {});
/// Part of Scene::support_travels in a tick: there and back before the tools leave.
double support_part(const Scene& scene, int tick);
/// Depth of the tool below the surface at rest at its place in a tick [m], in the change's units; negative outside.
double depth_of(const Scene& scene, std::size_t tool, int tick, const Change& change = {});
/// Ticks of the paths, with the pause of the change, which is at the beginning of the second phase.
int ticks_of(const Scene& scene, const Change& change = {});
/// First tick of the second phase, and the first after it.
int first_hold(const Scene& scene);
int last_hold(const Scene& scene, const Change& change = {});

}  // namespace cross
