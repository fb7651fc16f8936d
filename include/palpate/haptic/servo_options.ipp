// Definitions of servo_options.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/servo_options.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ForceLimits ServoOptions::limits() const {
  return force_limits.value_or(ForceLimits::from(device, rate));
}

PALPATE_INLINE std::vector<ContactTool> make_contact_tools(const std::vector<CapsuleTool>& tools,
                                                           const ServoOptions& options) {
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
