// Tools and contacts as the contact problem knows them.
#pragma once

#include <palpate/contact/bvh.hpp>

namespace palpate::inline PALPATE_ABI {

/// How far a tick may go.
struct ContactParameters {
  int maximum_iterations = 4;     ///< linearisations per tick
  double force_tolerance = 1e-3;  ///< relative change of the force between linearisations that ends the tick
  double sample_spacing = 0.5;    ///< of contact points on the surface, in radii of the smallest tool
};

/// Contacts of one contact problem unless it says otherwise.
inline constexpr int default_contact_capacity = 64;
/// Tools of one contact problem.
inline constexpr std::size_t maximum_tools = 8;

/// A ball as the contact problem knows it, in the model's frame.
struct ContactTool {
  Vector3 target = Vector3::Zero();  ///< where the device is [m]
  Vector3 proxy = Vector3::Zero();   ///< where the ball is: on the surface, never in it [m]
  Vector3 force = Vector3::Zero();   ///< of the tissue on the ball [N]
  double radius = 0.0;               ///< [m]
  double compliance = 0.0;           ///< of the coupling between proxy and device [m/N]; 0 is rigid
  Vector3 motion = Vector3::Zero();  ///< of the device since the last tick [m]
  bool active = false;               ///< takes part in this tick

  /// The proxy that a rigid tissue pushing back with `force` would allow.
  Vector3 goal(double floor) const noexcept { return target + (compliance + floor) * force; }
  /// The longest way of the proxy in one linearisation: points that far off are known.
  double longest_step() const noexcept { return 0.25 * radius + motion.norm(); }
};

/// One contact of one tool: a point of the deformed surface with the three vertices that carry it. The barycentric
/// weights that spread the force are those that read the displacement, so the contact makes no energy (Berkley et al.
/// 2004).
struct Contact {
  int tool = 0;
  Triangle vertices{};
  std::array<double, 3> weights{};
  Vector3 normal = Vector3::Zero();  ///< unit, from the surface to the ball's centre
  Vector3 rest = Vector3::Zero();    ///< the point when nothing touches [m]
  double gap = 0.0;                  ///< at the last linearisation [m]
  double force = 0.0;                ///< normal force [N], >= 0
  Vector3 point = Vector3::Zero();   ///< on the deformed surface [m]
};

}  // namespace palpate::inline PALPATE_ABI
