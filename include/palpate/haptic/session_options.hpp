// What a haptic session may choose; the rest its devices say.
#pragma once

#include <palpate/haptic/servo_options.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Everything is optional: force limits, stiffness and rate come from each device's limits(). What is given holds for
/// all tools and may be less than the devices allow, not more.
struct SessionOptions {
  std::optional<double> rate{};                ///< [1/s] default the slowest device's
  std::optional<double> coupling_stiffness{};  ///< [N/m] between proxy and device; default each device's, less in
                                               ///< proportion at a lower rate
  std::optional<double> rotational_stiffness{};  ///< [N m/rad] the same for rotations
  std::optional<ForceLimits> force_limits{};   ///< default ForceLimits::from(each device, rate)
  ContactParameters contact{};                 ///< friction too
  double stale_tissue_after = 0.5;             ///< [s] without news of a tissue that moves by itself until forces fade
  std::uint32_t grasp_buttons = 0;             ///< while one of these is pressed, the tool holds the point it touched
  bool limit_energy = false;                   ///< an EnergyTank per tool, EnergyLimits::from its device
};

/// The options of a servo for tools on these devices, one each. Throws bad_argument (ids: the device; value and
/// threshold) when there is not one device per tool, for a rate beyond a device's, and for a coupling or turning
/// stiffness, force, torque or continuous force beyond what a device renders, or force limits for another rate.
ServoOptions servo_options(const std::vector<DeviceLimits>& devices, std::size_t tools, const SessionOptions& options);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/session_options.ipp>
#endif
