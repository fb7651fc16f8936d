// Options of a haptic session that do not come from its devices.
#pragma once

#include <palpate/haptic/servo_options.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Everything is optional: defaults of force limits, stiffness and rate are each device's limits(). A given value is
/// valid for all tools and may be lower than the devices allow, not higher.
struct SessionOptions {
  std::optional<double> rate{};                  ///< [1/s] default: that of the slowest device
  std::optional<double> coupling_stiffness{};    ///< [N/m] between proxy and device; default: that of each device,
                                                 ///< reduced in proportion at a lower rate
  std::optional<double> rotational_stiffness{};  ///< [N m/rad] the same for rotations
  std::optional<ForceLimits> force_limits{};     ///< default ForceLimits::from(each device, rate)
  ContactParameters contact{};                   ///< includes friction
  double stale_tissue_after = 0.5;  ///< [s] without update of a tissue that moves by itself until forces fade
  bool corrected_force = false;     ///< whether ForceError::expected is subtracted from the force, where its
                                    ///< bound is at most a fifth of the force, in part up to two fifths
  std::uint32_t grasp_buttons = 0;  ///< while one of these is pressed, the tool grasps the point it touched
  bool limit_energy = false;        ///< an EnergyTank per tool, EnergyLimits::from its device
};

/// The options of a servo for tools on these devices, one each. Throws bad_argument (ids: the device; value and
/// threshold) when there is not one device per tool, for a rate above a device's, and for a coupling or rotational
/// stiffness, force, torque or continuous force above that of a device, or force limits for another rate.
ServoOptions servo_options(const std::vector<DeviceLimits>& devices, std::size_t tools, const SessionOptions& options);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/session_options.ipp>
#endif
