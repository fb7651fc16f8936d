// What a haptic session may choose, and the tools it makes of that.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/capsule_tool.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// What a session may choose.
struct ServoOptions {
  DeviceLimits device;                       ///< of the device that renders; gives the defaults below
  double rate = 1000.0;                      ///< [1/s] nominal rate of ticks
  std::optional<double> coupling_stiffness;  ///< [N/m] between proxy and device; default the device's stiffness,
                                             ///< infinity for verification
  std::optional<double> turning_stiffness;   ///< [N m/rad] the same for rotations; default the device's, or rigid for a
                                             ///< device that renders no torque
  std::optional<ForceLimits> force_limits;   ///< default ForceLimits::from(device, rate)
  ContactParameters contact;                 ///< friction too
  double stale_tissue_after = 0.5;           ///< [s] without news of a tissue that moves by itself until forces fade
  std::uint32_t grasp_buttons = 0;           ///< while one of these is pressed, the tool holds the point it touched

  /// The limits of the force gates.
  ForceLimits limits() const { return force_limits.value_or(ForceLimits::from(device, rate)); }
};

/// The tools of a session as contact knows them. Throws bad_argument for an invalid tool, coupling or number of tools.
inline std::vector<ContactTool> make_contact_tools(const std::vector<CapsuleTool>& tools, const ServoOptions& options) {
  if (tools.empty() || tools.size() > maximum_tools)
    raise(SetupErrorKind::bad_argument,
          "a servo has one to " + std::to_string(maximum_tools) + " tools, not " + std::to_string(tools.size()));
  const double stiffness = options.coupling_stiffness.value_or(options.device.stiffness);
  if (!(stiffness > 0.0))
    raise(SetupErrorKind::bad_argument, "the coupling stiffness is " + number(stiffness),
          "It must be positive, in N/m; infinity is allowed");
  const bool renders_torque = options.device.turning_stiffness > 0.0 || options.limits().peak_torque > 0.0;
  const double turning =
      options.turning_stiffness.value_or(renders_torque ? options.device.turning_stiffness : infinity);
  if (!(turning > 0.0))
    raise(SetupErrorKind::bad_argument, "the turning stiffness is " + number(turning),
          "A device that renders torque needs one, in N m/rad; infinity is allowed");
  std::vector<ContactTool> made;
  for (const CapsuleTool& tool : tools) {
    tool.require_valid();
    ContactTool& made_tool = made.emplace_back();
    made_tool.radius = tool.radius;
    made_tool.half_length = tool.half_length;
    if (tool.half_length > 0.0) made_tool.own_axis = tool.axis.normalized();
    made_tool.compliance = 1.0 / stiffness;
    made_tool.turning_compliance = 1.0 / turning;
  }
  return made;
}

}}  // namespace palpate
