// What a servo may choose, and the tools it makes of that.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/haptic/tool_list.hpp>

#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// What a servo may choose. Limits come from the devices that render; HapticSession asks them itself.
struct ServoOptions {
  DeviceLimits device{};                       ///< of the device that renders, where `devices` is empty
  std::vector<DeviceLimits> devices{};         ///< one per tool, where they differ
  std::optional<double> rate{};                ///< [1/s] of ticks; default the slowest device's
  std::optional<double> coupling_stiffness{};  ///< [N/m] between proxy and device; default each device's, less in
                                               ///< proportion at a lower rate; infinity for verification
  std::optional<double> rotational_stiffness{};  ///< [N m/rad] the same for rotations; default each device's, or rigid
                                                 ///< for a device that renders no torque
  std::optional<ForceLimits> force_limits{};   ///< of every tool; default ForceLimits::from(its device, rate)
  ContactParameters contact{};                 ///< friction too
  double stale_tissue_after = 0.5;             ///< [s] without news of a tissue that moves by itself until forces fade
  std::uint32_t grasp_buttons = 0;             ///< while one of these is pressed, the tool holds the point it touched

  const DeviceLimits& device_of(std::size_t tool) const noexcept { return devices.empty() ? device : devices[tool]; }
  /// [1/s]
  double tick_rate() const noexcept;
  /// The limits of a tool's force gate.
  ForceLimits limits(std::size_t tool = 0) const;
};

namespace detail {

/// What a stiffness that `device` renders stably at its own rate becomes at this one: less in proportion where it is
/// slower, since a held wall of stiffness K needs a damping of K T/2 (Colgate and Schenkel 1997).
double stable_at(double rate, const DeviceLimits& device, double stiffness) noexcept;

/// Of the coupling between a tool's proxy and its device [N/m]. Throws bad_argument (ids: the tool) unless positive.
double coupling_stiffness_of(std::size_t tool, const ServoOptions& options);

/// Radius of a tool without a sphere [m]: never the smallest, and never in contact.
inline constexpr double no_sphere = 1e6;

}  // namespace detail

/// The tools of a servo as contact knows them; blades as tools that are never active. Throws bad_argument for an
/// invalid tool, coupling or number of tools, or when there are `devices`, but not one per tool (ids: the tool).
std::vector<ContactTool> make_contact_tools(const ToolList& tools, const ServoOptions& options);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/servo_options.ipp>
#endif
