// The energy that a session gives to the hand: an observer measures it, an energy tank limits it.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// Passivity observer (Hannaford and Ryu, IEEE T-RA 18(1), 2002): the work of the forces on the tool from sampled
/// positions, f(n-1) . (x(n) - x(n-1)), with the force that acted in between. Steps that are not finite, or would
/// make the sum infinite, are ignored.
class PassivityObserver {
 public:
  /// `delay` in whole ticks, 0 to 32.
  explicit PassivityObserver(int delay = 0) noexcept;

  /// One interval between two samples.
  struct Step {
    double work = 0.0;          ///< [J] given to the tool
    double squared_path = 0.0;  ///< [m^2] square of the displacement
    double time = 0.0;          ///< [s] > 0, or 0 when the time stamps give no duration
  };

  /// Processes a new sample.
  Step moved(const Vector3& position, double time) noexcept;
  /// Adds other work, that of a torque.
  void moved_by(double work) noexcept { add(work); }
  /// Records the force that was rendered in response to that sample.
  void gave(const Vector3& force) noexcept;
  /// The displacement to the next sample is ignored: the device was lost, or the tool jumped.
  void forget() noexcept { known_ = false; }

  /// [J] given to the tool since construction; below zero: taken from it. Always finite.
  double given() const noexcept { return given_; }
  /// [N] the force that acts until the next sample.
  const Vector3& acting() const noexcept;

 private:
  void add(double work) noexcept;

  std::array<Vector3, 33> forces_;
  std::size_t delay_, newest_ = 0;
  Vector3 last_ = Vector3::Zero();
  double last_time_ = 0.0, given_ = 0.0;
  bool known_ = false;
};

/// Energy that a session may give to a tool.
struct EnergyLimits {
  double allowance = 1.1e-3;  ///< [J] that may be given beyond what was put in; below half of it forces are scaled down
  double refill = 1.1e-3;     ///< [W] rate at which the allowance refills
  double capacity = 0.1;      ///< [J] largest stored energy of what the hand put in
  double damping = 0.25;      ///< [N s/m] dissipation b of the device itself: adds b v^2 to the tank
  int delay = 0;              ///< whole ticks after which a written force acts, up to 32

  /// For a device. Its own damping is derived from the stiffness it renders stably at its rate: a sampled wall of
  /// stiffness K with zero-order hold generates K T/2 v^2 (Colgate and Schenkel 1997), so a device on which it is
  /// stable dissipates at least about that. The allowance is a tenth of the energy that a spring of that stiffness
  /// stores at the peak force; no linear tissue that the peak force dents by less than 60 mm stores more than the
  /// capacity.
  static EnergyLimits from(const DeviceLimits& device);
};

/// Energy tank: energy that the hand puts in fills it, energy given back empties it. Below half the allowance every
/// force is multiplied by (level / half the allowance): a gain that depends on the energy, not on the velocity, so that
/// slow motion over encoder steps causes no noise (dividing by a velocity, as the passivity controller of Hannaford and
/// Ryu does, would). When the tool is free, the stored energy above the allowance is discarded, as no tissue stores
/// any.
/// - A spring up to the device's rated stiffness, sampled at 1 kHz or faster, is never limited, with encoder steps too.
/// - For any computed force, the tool gets at most allowance + refill * time + the energy its device dissipates, and
/// one
///   tick's work beyond that each time the tank runs empty.
/// An option of HapticServo. Cost: about 10 ns; no allocation, no throw; the level is finite for any input.
class EnergyTank {
 public:
  /// Throws SetupError(bad_argument) unless limits are finite and >= 0, the allowance >= 1e-12, the capacity at least
  /// that, the delay 0 to 32.
  explicit EnergyTank(const EnergyLimits& limits = {});

  /// The force to render instead of `wanted`, for a tool that was at `position` [m] at `time` [s]. Sets energy_injected
  /// when that is less.
  Vector3 limit(const Vector3& wanted, const Vector3& position, double time, Status& status) noexcept;
  /// Adds the work of a torque on the tool since the last call of limit [J]; call it before the next limit.
  void rotated(double work) noexcept;
  /// Records the force that was finally rendered.
  void gave(const Vector3& force) noexcept { observer_.gave(force); }
  /// The device was lost, or the tool jumped: the displacement to the next sample is ignored.
  void forget() noexcept { observer_.forget(); }
  void reset() noexcept;

  double level() const noexcept { return level_; }  ///< [J]
  double gain() const noexcept;
  const EnergyLimits& limits() const noexcept { return limits_; }

 private:
  static constexpr double longest_refill = 0.1;  ///< [s] a stall does not fill the tank
  static constexpr double shortest_step = 1e-5;  ///< [s] nor do time stamps that are too close
  static void require(bool holds, const std::string& what);

  EnergyLimits limits_;
  PassivityObserver observer_;
  double level_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/energy_tank.ipp>
#endif
