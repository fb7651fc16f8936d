// Definitions of servo_options.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/servo_options.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE DeviceLimits ServoOptions::device_of(std::size_t tool) const noexcept {
  if (devices.empty()) return {};
  return devices.size() == 1 ? devices.front() : devices[tool];
}

PALPATE_INLINE double ServoOptions::tick_rate() const noexcept {
  double slowest = devices.empty() ? DeviceLimits{}.rate : infinity;
  for (const DeviceLimits& d : devices) slowest = std::min(slowest, d.rate);
  return rate.value_or(slowest);
}

PALPATE_INLINE ForceLimits ServoOptions::limits(std::size_t tool) const {
  return force_limits.value_or(ForceLimits::from(device_of(tool), tick_rate()));
}

namespace detail {

PALPATE_INLINE double stable_at(double rate, const DeviceLimits& device, double stiffness) noexcept {
  return rate < device.rate ? stiffness * (rate / device.rate) : stiffness;
}

/// Smallest stiffness of a coupling [N/m], [N m/rad]: with less, its compliance could overflow.
inline constexpr double softest_coupling = 1e-6;

[[noreturn]] inline void refuse_stiffness(std::size_t tool, const char* which, double value, const char* hint) {
  SetupProblem problem;
  problem.what = std::string("the ") + which + " stiffness is " + number(value);
  problem.hint = hint;
  problem.value = value;
  const std::int64_t id = static_cast<std::int64_t>(tool);
  problem.set_ids({&id, 1});
  raise(std::move(problem));
}

PALPATE_INLINE double coupling_stiffness_of(std::size_t tool, const ServoOptions& options) {
  const DeviceLimits device = options.device_of(tool);
  const double stiffness =
      options.coupling_stiffness.value_or(stable_at(options.tick_rate(), device, device.stiffness));
  if (!(stiffness >= softest_coupling))
    refuse_stiffness(tool, "coupling", stiffness, "It must be at least 1e-6 N/m; infinity is allowed");
  return stiffness;
}

/// A tool of a radius, with its coupling.
inline ContactTool make_coupled_tool(double radius, std::size_t i, const ServoOptions& options) {
  const DeviceLimits device = options.device_of(i);
  const double rate = options.tick_rate(), stiffness = coupling_stiffness_of(i, options);
  const bool renders_torque = device.rotational_stiffness > 0.0 || options.limits(i).peak_torque > 0.0;
  const double rotational = options.rotational_stiffness.value_or(
      renders_torque ? stable_at(rate, device, device.rotational_stiffness) : infinity);
  if (!(rotational >= softest_coupling))
    refuse_stiffness(i, "rotational", rotational,
                     "A device that renders torque needs at least 1e-6 N m/rad; infinity is allowed");
  ContactTool made;
  made.radius = radius;
  made.compliance = 1.0 / stiffness;
  made.rotational_compliance = 1.0 / rotational;
  return made;
}

inline ContactTool make_contact_tool(const CapsuleTool& tool, std::size_t i, const ServoOptions& options) {
  ContactTool made = make_coupled_tool(tool.radius, i, options);
  tool.require_valid();
  made.half_length = tool.half_length;
  if (tool.half_length > 0.0) made.own_axis = tool.axis.normalized();
  return made;
}

inline ContactTool make_contact_tool(const ConvexTool& tool, std::size_t i, const ServoOptions& options) {
  ContactTool made = make_coupled_tool(tool.radius(), i, options);
  made.half_length = tool.hull().extent();
  made.hull = &tool.hull();
  return made;
}

PALPATE_INLINE std::vector<ContactTool> make_contact_tools(const ToolList& tools, const ServoOptions& options) {
  if (tools.size() == 0 || tools.size() > maximum_tools)
    raise(SetupErrorKind::bad_argument,
          "a servo has one to " + std::to_string(maximum_tools) + " tools, not " + std::to_string(tools.size()));
  if (options.devices.size() > 1 && options.devices.size() != tools.size())
    raise(SetupErrorKind::bad_argument,
          "ServoOptions has limits of " + std::to_string(options.devices.size()) + " devices for " +
              std::to_string(tools.size()) + " tools",
          "Give ServoOptions::devices one entry per tool, or one for all");
  std::vector<ContactTool> made;
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (const auto* sphere = std::get_if<SphereTool>(&tools[i]))
      made.push_back(make_contact_tool(*sphere, i, options));
    else if (const auto* capsule = std::get_if<CapsuleTool>(&tools[i]))
      made.push_back(make_contact_tool(*capsule, i, options));
    else if (const auto* convex = std::get_if<ConvexTool>(&tools[i]))
      made.push_back(make_contact_tool(*convex, i, options));
    else
      made.emplace_back().radius = no_sphere;
  }
  return made;
}

}  // namespace detail

}}  // namespace palpate
