// The scene: the organ, its materials, its supports, and the path of the tool.
#pragma once

#include <palpate/io.hpp>
#include <palpate/palpate.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include <Eigen/QR>
#include <Eigen/Geometry>

namespace touch {

using namespace palpate;

// A model is defined by element, material and solver. Smoothed<Tet4> is Tet4 without locking, since tissue is nearly
// incompressible. Condensed<SelectiveInverse> keeps the nodes that a tool can reach and reads their compliance from a
// stored inverse: the least work in a tick.
using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;

inline const RegionMaterials<LinearElastic> materials{
    {"parenchyma", {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}},  // soft, nearly incompressible
    {"lesion", {.youngs_modulus = 50e3, .poisson_ratio = 0.45, .density = 1060.0}},  // the stiff inclusion to be found
};

/// The nodes of all boundary triangles that face downwards: the surface on which the organ rests.
inline std::vector<NodeId> underside(const Mesh<Tet4>& mesh) {
  std::vector<NodeId> nodes;
  for (const auto& face : extract_boundary<Tet4>(mesh)) {
    const Vector3 a = mesh.position(face.nodes[0]), b = mesh.position(face.nodes[1]), c = mesh.position(face.nodes[2]);
    if ((b - a).cross(c - a).normalized().z() < -0.5) nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
  }
  return nodes;
}

/// A 4 mm probe on a patch of triangles that are 4 mm long. The set-up measures how far its forces are in error, and
/// every tick has an error bar.
inline constexpr SphereTool tool{.radius = 4e-3};

/// Conditions refer to a named group of the mesh file or to a list of nodes. There is no gravity here: the mesh is the
/// shape of the organ under its weight. (With gravity it would be flattened by another 2.8 mm.)
inline Scene make_scene(const Mesh<Tet4>& mesh) {
  Scene scene;
  scene.fix("ligament").fix(underside(mesh)).touch("front", {.radius = tool.radius}).render("surface");
  return scene;
}

/// How the tool moves; lengths in [m].
struct Plan {
  double seconds = 10.0;
  double depth = 2e-3;    ///< depth of the press: half the radius, which linear tissue shows well
  double drag = 30e-3;    ///< length of the slide, half of it on either side of the lesion
  double height = 12e-3;  ///< of the sphere above the surface before and after
};

/// A right-angled frame on the touchable surface: `x` along its longest extent, `z` outward.
struct PatchFrame {
  Vector3 origin, x, y, z;
  double depth;  ///< of the centre of the region below the surface [m]
};

/// The frame above the region `name`, in the model's coordinates.
inline PatchFrame frame_above(const Organ& organ, std::string_view name) {
  Vector3 middle = Vector3::Zero();
  double count = 0.0;
  for (Index e = 0; e < organ.mesh().element_count(); ++e) {
    if (organ.mesh().region_name(organ.mesh().region(e)) != name) continue;
    middle += element_nodes<Tet4>(organ.mesh(), e).colwise().mean().transpose();
    count += 1.0;
  }
  const ContactSurface& surface = organ.contact_surface();
  const auto closest = surface.closest(middle / count);

  Vector3 normal = Vector3::Zero(), low = surface.position(0), high = low;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t) normal += surface.normal(t);
  for (const Vector3& p : surface.positions()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  PatchFrame frame{closest.point, {}, {}, normal.normalized(), -closest.distance};
  int longest = 0;
  (high - low).maxCoeff(&longest);
  frame.y = frame.z.cross(Vector3::Unit(longest)).normalized();
  frame.x = frame.y.cross(frame.z);
  return frame;
}

/// Down, across and up again; the slide is at constant depth. The surface consists of flat triangles, but a hand would
/// follow its smooth shape, so the path follows the paraboloid fitted to its vertices.
class TouchPath {
 public:
  TouchPath(const Organ& organ, const Plan& plan)
      : frame_(frame_above(organ, "lesion")), to_world_(organ.to_world()), over_patch_(moves(plan)) {
    const auto& vertices = organ.contact_surface().positions();
    MatrixX monomials(static_cast<Index>(vertices.size()), 6);
    VectorX heights(monomials.rows());
    for (Index i = 0; i < monomials.rows(); ++i) {
      const Vector3 p = vertices[static_cast<std::size_t>(i)] - frame_.origin;
      monomials.row(i) = row(p.dot(frame_.x), p.dot(frame_.y));
      heights[i] = p.dot(frame_.z);
    }
    hill_ = monomials.colPivHouseholderQr().solve(heights);
  }

  /// Centre of the sphere [m], world frame.
  Vector3 operator()(double t) const noexcept {
    const Vector3 p = over_patch_(t);
    const double height = p[2] + row(p[0], p[1]).dot(hill_);
    return to_world_ * Vector3(frame_.origin + p[0] * frame_.x + p[1] * frame_.y + height * frame_.z);
  }
  /// Outward direction of the patch.
  const Vector3& outward() const noexcept { return frame_.z; }
  /// Depth of the centre of the lesion [m].
  double target_depth() const noexcept { return frame_.depth; }

 private:
  /// Along the patch (x) and above the paraboloid (z).
  static Trajectory moves(const Plan& p) {
    const double left = -0.5 * p.drag, right = 0.5 * p.drag, above = tool.radius + p.height, in = tool.radius - p.depth;
    const auto at = [&](double share, double x, double z) {
      return Trajectory::Waypoint{share * p.seconds, {x, 0.0, z}};
    };
    return Trajectory({at(0.0, left, above), at(0.03, left, above), at(0.25, left, in), at(0.30, left, in),
                       at(0.72, right, in), at(0.77, right, in), at(0.97, right, above)});
  }
  static Eigen::Matrix<double, 1, 6> row(double x, double y) noexcept { return {1.0, x, y, x * x, x * y, y * y}; }

  PatchFrame frame_;
  Eigen::Isometry3d to_world_;
  Trajectory over_patch_;
  Eigen::Matrix<double, 6, 1> hill_;
};

}  // namespace touch
