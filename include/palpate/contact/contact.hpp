// Tools and contacts as the contact problem represents them.
#pragma once

#include <palpate/contact/detail/triangle.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Default number of contacts of one contact problem.
inline constexpr int default_contact_capacity = 64;
/// Largest number of tools of one contact problem.
inline constexpr std::size_t maximum_tools = 8;

/// Limits and parameters of the contact solution of a tick.
struct ContactParameters {
  int maximum_iterations = 4;               ///< linearisations per tick
  double force_tolerance = 1e-3;            ///< relative change of the force between linearisations that ends the tick
  bool local_compliance = true;             ///< spheres smaller than facets get the dent that facets do not show
  double sample_spacing = 0.5;              ///< of contact points on the surface, in radii of the smallest tool
  double friction = 0.0;                    ///< Coulomb's coefficient; 0 has no cost
  int capacity = default_contact_capacity;  ///< of contacts of all tools; more are ignored (degraded_model)
};

/// A sphere or capsule as the contact problem represents it, in the model's frame.
struct ContactTool {
  Vector3 target = Vector3::Zero();  ///< position of the device [m]
  Vector3 proxy = Vector3::Zero();   ///< of the tool on the surface of the mesh, never inside [m]
  Vector3 force = Vector3::Zero();   ///< of the tissue on the tool [N]
  double radius = 0.0;               ///< [m]
  double compliance = 0.0;           ///< of the coupling between proxy and device [m/N]; 0 is rigid
  double local_compliance = 0.0;     ///< of the dent that coarse facets do not show, at the last force [m/N]
  Vector3 motion = Vector3::Zero();  ///< of the device since the last tick [m]
  bool active = false;               ///< takes part in this tick
  bool grasping = false;             ///< grasps the point it touched when this became true

  double half_length = 0.0;                       ///< of a capsule's axis [m]; 0 is a sphere
  Vector3 own_axis{0.0, 0.0, 1.0};                ///< of a capsule, in the tool's own frame, unit
  Matrix3 target_rotation = Matrix3::Identity();  ///< of the device: from the tool's own frame
  Matrix3 rotation = Matrix3::Identity();         ///< of the proxy
  Vector3 torque = Vector3::Zero();               ///< of the tissue on the tool, about the proxy [N m]
  double rotational_compliance = 0.0;             ///< of the coupling [rad/(N m)]; 0 is rigid
  double end_path = 0.0;                          ///< of the capsule's ends around its middle, last tick [m]

  Vector3 friction_displacement = Vector3::Zero(),
          friction_rotation = Vector3::Zero();  ///< of the coupling under friction [m], [rad]

  /// Makes the tool inactive and sets force and torque to zero.
  void lift() noexcept;
  /// Back to the state before the first tick; geometry and coupling stay.
  void reset() noexcept;
  /// Between the device and the proxy [m/N].
  double total_compliance() const noexcept { return compliance + local_compliance; }
  /// Where the tool is: in the dent that coarse facets do not show, deeper than its proxy [m].
  Vector3 position() const noexcept;
  /// Position of the proxy at which the coupling balances `force`; `floor` [m/N] is added to the compliance.
  Vector3 goal(double floor) const noexcept;
  /// The same for the rotation.
  Matrix3 goal_rotation() const noexcept;
  Vector3 axis() const noexcept;
  /// Coordinate on the axis, from the middle, of the point closest to `p` [m].
  double along(const Vector3& p) const noexcept { return half_length > 0.0 ? along_capsule(p) : 0.0; }
  /// Upper bound of the path of the device since the last tick, at the end that moved most [m].
  double path_length() const noexcept;
  /// Longest path of the proxy in one linearisation: contact points up to this distance are in the list.
  double longest_step() const noexcept { return 0.25 * radius + path_length(); }

 private:
  double along_capsule(const Vector3& p) const noexcept;
};

/// One contact of one tool: a point of the deformed surface and the three vertices of its triangle. The barycentric
/// weights that distribute the force also interpolate the displacement, so the contact generates no energy (Berkley et
/// al. 2004).
struct Contact {
  int tool = 0;
  Triangle vertices{};
  std::array<double, 3> weights{};
  Vector3 normal = Vector3::Zero();    ///< unit, from the surface to the sphere's centre
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
