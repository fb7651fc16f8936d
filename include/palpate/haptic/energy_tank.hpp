// A tank that limits what energy a session gives to the hand.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/haptic/passivity_observer.hpp>

#include <optional>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// What a session may give to a tool.
struct EnergyLimits {
  double allowance = 1.1e-3;  ///< [J] more than was put in; below half of it forces are scaled down
  double refill = 1.1e-3;     ///< [W] what the allowance comes back with
  double capacity = 0.1;      ///< [J] the most that can be kept of what the hand put in
  double damping = 0.25;      ///< [N s/m] what the device itself dissipates: gives the tank b v^2
  int delay = 0;              ///< whole ticks after which a written force acts, up to 32

  /// For a device. Its own damping is taken from the stiffness it renders stably at its rate: a held wall of stiffness
  /// K gives K T/2 v^2 (Colgate and Schenkel 1997), so a device on which it is stable takes at least about that. The
  /// allowance is a tenth of what a spring of that stiffness stores at the peak force; no linear tissue that the peak
  /// force dents by less than 60 mm stores more than the capacity.
  static EnergyLimits from(const DeviceLimits& device);
};

/// Energy tank: what the hand puts in fills it, what it gets back empties it. Below half the allowance every force is
/// multiplied by (level / half the allowance): a gain that follows the energy, not the velocity, so that slow motion
/// over encoder steps makes no noise (dividing by a velocity, as the passivity controller of Hannaford and Ryu does,
/// would). Nothing is kept of what a contact put in once the tool is free: then no tissue stores anything.
/// - A spring up to the device's rated stiffness, sampled at 1 kHz or faster, is never touched, with encoder steps too.
/// - Whatever computes the force, the tool gets at most allowance + refill * time + what its device dissipates, and one
///   tick's work beyond that each time the tank runs empty.
/// An option of HapticServo. Cost: about 10 ns; no allocation, no throw; whatever comes in, the level is finite.
class EnergyTank {
 public:
  /// Throws SetupError(bad_argument) unless limits are finite and >= 0, the allowance >= 1e-12, the capacity at least
  /// that, the delay 0 to 32.
  explicit EnergyTank(const EnergyLimits& limits = {});

  /// The force to pass on instead of `wanted`, for a tool that was at `position` [m] at `time` [s]. Sets
  /// energy_injected when that is less.
  Vector3 limit(const Vector3& wanted, const Vector3& position, double time, Status& status) noexcept;
  /// Takes in the work of a torque on the tool since the last call of limit [J], before that is called again.
  void rotated(double work) noexcept;
  /// What was rendered in the end.
  void gave(const Vector3& force) noexcept;
  /// The device was lost, or the tool jumped: the way to the next sample does not count.
  void forget() noexcept;
  void reset() noexcept;

  double level() const noexcept { return level_; }  ///< [J]
  double gain() const noexcept;
  const PassivityObserver& observer() const noexcept { return observer_; }
  const EnergyLimits& limits() const noexcept { return limits_; }

 private:
  static constexpr double longest_refill = 0.1;  ///< [s] a stall does not fill the tank,
  static constexpr double shortest_step = 1e-5;  ///< [s] nor do stamps that lie too close
  static void require(bool holds, const std::string& what);

  EnergyLimits limits_;
  PassivityObserver observer_;
  double level_;
};

/// For a servo that observes no energy, at no cost.
struct NoEnergyTank {
  operator std::optional<EnergyTank>() const noexcept { return {}; }  // NOLINT(google-explicit-constructor)
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/energy_tank.ipp>
#endif
