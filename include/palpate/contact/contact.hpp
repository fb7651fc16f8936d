// Tools and contacts as the contact problem represents them.
#pragma once

#include <palpate/contact/convex_hull.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

/// Largest number of tools of one contact problem.
inline constexpr std::size_t maximum_tools = 8;
/// Default number of contacts of a contact problem with one tool, and what every other tool adds; as many times more
/// where tissue is at large strain.
inline constexpr int default_contact_capacity = 64, default_capacity_per_tool = 32, capacity_at_large_strain = 2;
/// The default with all tools.
inline constexpr int largest_default_capacity =
    capacity_at_large_strain *
    (default_contact_capacity + default_capacity_per_tool * (static_cast<int>(maximum_tools) - 1));

/// Vertices that may carry force, per contact: those of the rows, and of the rows before where steps are cut short.
inline constexpr int vertices_per_contact = 12;

/// Radii of the tools of a session [m].
struct ToolRadii {
  double smallest, largest;
  double largest_scale;                                             ///< ContactTool::point_scale
  ToolRadii(double radius) noexcept : ToolRadii(radius, radius) {}  // NOLINT(google-explicit-constructor)
  ToolRadii(double least, double most) noexcept : smallest(least), largest(most), largest_scale(most) {}
  friend bool operator==(const ToolRadii&, const ToolRadii&) = default;
};

/// Limits and parameters of the contact solution of a tick.
struct ContactParameters {
  int maximum_iterations = 4;       ///< linearisations per tick
  double force_tolerance = 1e-3;    ///< relative change of the force between linearisations that ends the tick; for
                                    ///< spheres without friction also its estimate after the first one
  bool subfacet_compliance = true;  ///< points finer than facets, where the surface has a SubfacetCompliance
  int pressing_points = 18;         ///< of them in a press, about the same at any depth and on any mesh; at large
                                    ///< strain on finer meshes as many as vertices
  double sample_spacing = 0.5;      ///< of contact points on other surfaces, in radii of the smallest tool
  double friction = 0.0;            ///< Coulomb's coefficient; 0 has no cost
  double grasp_radius = 0.0;        ///< [m] a tool that grasps holds the vertices within it, up to eight; 0: one point
  int capacity = 0;  ///< of contacts of all tools; of more, evenly spread ones are kept (degraded_model);
                     ///< 0: the default for the tools

  /// The same with a capacity for this number of tools, on tissue at large strain or not.
  ContactParameters for_tools(std::size_t tools, bool large_strain = false) const noexcept;
};

namespace detail {

/// The point of a tool's core closest to another point. The core is the centre of a sphere, the segment of a capsule or
/// the hull of a convex tool: the tool is all points within its radius of the core.
struct CorePoint {
  Vector3 point = Vector3::Zero();   ///< from the tool's position, in its own frame [m]
  Vector3 normal = Vector3::Zero();  ///< unit, from the other point to this one; inside a hull from it to its nearest
                                     ///< face, reversed
  double distance = 0.0;             ///< [m], negative inside a hull; convex
};

}  // namespace detail

/// A tool as the contact problem represents it, in the model's frame.
struct ContactTool {
  Vector3 target = Vector3::Zero();  ///< position of the device [m]
  Vector3 proxy = Vector3::Zero();   ///< of the tool on the surface of the mesh, never inside [m]
  Vector3 force = Vector3::Zero();   ///< of the tissue on the tool [N]
  double radius = 0.0;               ///< [m]
  double compliance = 0.0;           ///< of the coupling between proxy and device [m/N]; 0 is rigid
  Vector3 motion = Vector3::Zero();  ///< of the device since the last tick [m]
  bool active = false;               ///< takes part in this tick
  bool grasping = false;             ///< grasps the point it touched when this became true

  double half_length = 0.0;                       ///< farthest point of the core from the tool's position [m]: of a
                                                  ///< capsule half of its axis; 0 is a sphere
  const ConvexHull* hull = nullptr;               ///< core of a convex tool, in its own frame, not owned; else null
  Vector3 own_axis{0.0, 0.0, 1.0};                ///< of a capsule, in the tool's own frame, unit
  Matrix3 target_rotation = Matrix3::Identity();  ///< of the device: from the tool's own frame
  Matrix3 rotation = Matrix3::Identity();         ///< of the proxy
  Vector3 torque = Vector3::Zero();               ///< of the tissue on the tool, about the proxy [N m]
  double rotational_compliance = 0.0;             ///< of the coupling [rad/(N m)]; 0 is rigid
  double end_path = 0.0;                          ///< bound of the path of its core by rotation, last tick [m]
  Vector3 outward = Vector3::Zero();              ///< of a sphere that presses, or a capsule with its side: where it
                                                  ///< came from, unit; else zero
  double entered = -infinity;  ///< height of its highest contact at rest above its core, along `outward` [m]

  /// Makes the tool inactive and sets force and torque to zero.
  void lift() noexcept;
  /// Back to the state before the first tick; geometry and coupling stay.
  void reset() noexcept;
  /// Position of the proxy at which the coupling balances `force`; `floor` [m/N] is added to the compliance.
  Vector3 goal(double floor) const noexcept;
  /// The same for the rotation.
  Matrix3 goal_rotation() const noexcept;
  Vector3 axis() const noexcept;
  /// The point of the core closest to `p`.
  detail::CorePoint closest(const Vector3& p) const noexcept {
    if (outward.squaredNorm() > 0.0) return closest_pressed(p);
    return half_length > 0.0 ? closest_extended(p) : from_core(p, proxy, Vector3(0.0, 0.0, 0.0));
  }
  /// Upper bound of the displacement of any point of the core by a change of its rotation matrix [m].
  double core_path(const Matrix3& change) const noexcept;
  /// Centre of a sphere that contains the core [m].
  Vector3 middle() const noexcept;
  /// Radius of that sphere [m].
  double core_radius() const noexcept {
    if (hull != nullptr) return hull->radius();
    return half_length + (has_cone() ? 0.2 * radius + 1.1 * std::max(0.0, entered) : 0.0);
  }
  /// What the largest spacing of its contact points is relative to [m]: the radius of a sphere or capsule. The faces of
  /// a convex tool may be much larger than the radius of its edges.
  double point_scale() const noexcept { return hull != nullptr ? radius + 0.5 * hull->radius() : radius; }
  /// Whether it came from `direction` and may have a cone: a sphere, or a capsule that does not press with an end. What
  /// is beside the shaft of a stylus does not part. A convex tool has steep sides.
  bool may_have_cone(const Vector3& direction) const noexcept {
    constexpr double end_on = 0.5;  // 60 degrees from the axis
    return hull == nullptr && (half_length == 0.0 || std::abs(axis().dot(direction)) < end_on);
  }
  /// Height of `p` above the core, along `outward` [m].
  double height(const Vector3& p) const noexcept;
  /// Whether it has entered material above the rim of its cap, where its cone begins.
  bool has_cone() const noexcept { return entered > -cone_cosine * radius; }
  /// Upper bound of the path of any point of the surface of cap and cone by a change of `outward` and `entered` [m].
  double cone_path(const Vector3& outward_before, double entered_before) const noexcept;
  /// Upper bound of the path of the device since the last tick, at the end that moved most [m].
  double path_length() const noexcept;
  /// Longest path of the proxy in one linearisation: contact points up to this distance are in the list.
  double longest_step() const noexcept { return 0.25 * radius + path_length(); }

 private:
  // Of the rim of the cap, from `outward` reversed: 60 degrees.
  static constexpr double cone_cosine = 0.5, cone_sine = 0.8660254037844386;
  detail::CorePoint closest_extended(const Vector3& p) const noexcept;
  detail::CorePoint closest_pressed(const Vector3& p) const noexcept;
  double along_cone(const Vector3& p, const Vector3& direction) const noexcept;
  double along_capsule(const Vector3& p, const Vector3& direction) const noexcept {
    return std::clamp(direction.dot(p - proxy), -half_length, half_length);
  }
  /// For a point of the core in the model's frame, and in the tool's own.
  static detail::CorePoint from_core(const Vector3& p, const Vector3& core, const Vector3& own) noexcept {
    const Vector3 offset = core - p;
    const double distance = offset.norm();
    return {own, distance > 0.0 ? Vector3(offset / distance) : Vector3(0.0, 0.0, 1.0), distance};
  }
};

/// One contact of one tool: a point of the deformed surface and the three vertices of its triangle. The barycentric
/// weights that distribute the force also interpolate the displacement, so the contact generates no energy (Berkley et
/// al. 2004).
struct Contact {
  int tool = 0;
  Triangle vertices{};
  std::array<double, 3> weights{};
  Vector3 normal = Vector3::Zero();    ///< unit, from the surface to the tool's core
  Vector3 rest = Vector3::Zero();      ///< position of the point without contact [m]
  double force = 0.0;                  ///< normal force [N], >= 0; of a grasp: along `normal`, any sign
  Vector3 point = Vector3::Zero();     ///< on the deformed surface [m]
  Vector3 friction = Vector3::Zero();  ///< on the tool, tangential [N]
  Vector3 arm = Vector3::Zero();       ///< from the proxy to the contact point on the tool [m]
  double offset = 0.0;   ///< of that point from the target, along the normal, when the proxy is at the target [m]
  bool grasped = false;  ///< bilateral: one of three rows of a grasped point

  /// Total force on the tool [N].
  Vector3 total() const noexcept;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/contact.ipp>
#endif
