// Options of a servo, and its contact tools.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/haptic/force_gate.hpp>

#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Options of a servo, also of the one in a HapticSession. Everything is optional: defaults of rate, stiffness and
/// force limits are those of the devices. A given value is valid for all tools. A session takes `devices` from its
/// devices and refuses values that are higher than they allow; a servo alone accepts them, for verification.
struct ServoOptions {
  std::optional<double> rate{};                  ///< [1/s] of ticks; default: that of the slowest device
  std::optional<double> coupling_stiffness{};    ///< [N/m] between proxy and device; default: that of each device,
                                                 ///< reduced in proportion at a lower rate; infinity for verification
  std::optional<double> rotational_stiffness{};  ///< [N m/rad] the same for rotations; default: that of each device, or
                                                 ///< rigid for a device that renders no torque
  std::optional<ForceLimits> force_limits{};     ///< of every tool; default ForceLimits::from(its device, rate)
  ContactParameters contact{};                   ///< includes friction
  double stale_tissue_after = 0.5;      ///< [s] without update of a tissue that moves by itself until forces fade
  bool corrected_force = false;         ///< whether ForceError::expected is subtracted from the force, where its
                                        ///< bound is at most a fifth of the force, in part up to two fifths
  std::uint32_t grasp_buttons = 0;      ///< while one of these is pressed, the tool grasps the point it touched
  bool limit_energy = false;            ///< an EnergyTank per tool, EnergyLimits::from its device
  std::vector<DeviceLimits> devices{};  ///< that render: one for all tools, or one per tool; none: DeviceLimits{}.
                                        ///< Empty in the options of a session

  DeviceLimits device_of(std::size_t tool) const noexcept;
  /// [1/s]
  double tick_rate() const noexcept;
  /// The limits of a tool's force gate.
  ForceLimits limits(std::size_t tool = 0) const;
};

namespace detail {

/// The stiffness that a device renders stably at `rate`, for one that it renders stably at its own rate: reduced in
/// proportion at a lower rate, since a sampled wall of stiffness K needs a damping of K T/2 (Colgate and Schenkel
/// 1997).
double stable_at(double rate, const DeviceLimits& device, double stiffness) noexcept;

/// Stiffness of the coupling between a tool's proxy and its device [N/m]. Throws bad_argument (ids: the tool) unless
/// positive.
double coupling_stiffness_of(std::size_t tool, const ServoOptions& options);

/// Radius of a tool without a sphere [m]: so large that it is never the smallest radius; never in contact.
inline constexpr double no_sphere = 1e6;

/// The tools of a servo in the contact problem; blades as tools that are never active. They refer to the shapes of the
/// convex tools of the list, which must outlive them. Throws bad_argument for an
/// invalid tool, coupling or number of tools, or when there are several `devices`, but not one per tool (ids: the
/// tool).
std::vector<ContactTool> make_contact_tools(const ToolList& tools, const ServoOptions& options);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/servo_options.ipp>
#endif
