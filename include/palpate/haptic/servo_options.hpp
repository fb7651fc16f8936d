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
  ForceLimits limits() const;
};

/// The tools of a session as contact knows them. Throws bad_argument for an invalid tool, coupling or number of tools.
std::vector<ContactTool> make_contact_tools(const std::vector<CapsuleTool>& tools, const ServoOptions& options);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/servo_options.ipp>
#endif
