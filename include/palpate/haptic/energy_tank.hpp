// A tank that limits what energy a session gives to the hand.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/passivity_observer.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// What a session may give to a tool.
struct EnergyLimits {
  double allowance = 1.1e-3;  ///< [J] more than was put in; below half of it forces are scaled down
  double refill = 1.1e-3;     ///< [W] what the allowance comes back with
  double capacity = 0.1;      ///< [J] the most that can be kept of what the hand put in
  double damping = 0.25;      ///< [N s/m] what the device itself dissipates: gives the tank b v^2
  int delay = 0;              ///< whole ticks after which a written force acts, up to 32

  /// For a device. Its own damping is taken from the stiffness it renders stably at 1 kHz: a held wall of stiffness K
  /// gives K T/2 v^2 (Colgate and Schenkel 1997), so a device on which it is stable takes at least about that. The
  /// allowance is a tenth of what a spring of that stiffness stores at the peak force; no linear tissue that the peak
  /// force dents by less than 60 mm stores more than the capacity.
  static EnergyLimits from(const DeviceLimits& device) {
    EnergyLimits limits;
    limits.damping = device.stiffness * 0.5e-3;
    limits.allowance = limits.refill = 0.05 * device.peak_force * device.peak_force / device.stiffness;
    limits.capacity = std::max(0.03 * device.peak_force, limits.allowance);
    return limits;
  }
};

/// Energy tank: what the hand puts in fills it, what it gets back empties it. Below half the allowance every force is
/// multiplied by (level / half the allowance): a gain that follows the energy, not the velocity, so that slow motion
/// over encoder steps makes no noise (dividing by a velocity, as the passivity controller of Hannaford and Ryu does,
/// would). Nothing is kept of what a contact put in once the tool is free: then no tissue stores anything.
/// - A spring up to the device's rated stiffness, sampled at 1 kHz or faster, is never touched, with encoder steps too.
/// - Whatever computes the force, the tool gets at most allowance + refill * time + what its device dissipates, and one
///   tick's work beyond that each time the tank runs empty.
/// A policy of HapticServo. Cost: about 10 ns; no allocation, no throw; whatever comes in, the level is finite.
class EnergyTank {
 public:
  /// Throws SetupError(bad_argument) unless limits are finite and >= 0, the allowance >= 1e-12, the capacity at least
  /// that, the delay 0 to 32.
  explicit EnergyTank(const EnergyLimits& limits = {})
      : limits_(limits), observer_(limits.delay), level_(limits.allowance) {
    for (double value : {limits.allowance, limits.refill, limits.capacity, limits.damping})
      require(value >= 0.0 && value <= 1e9, "an energy limit is " + number(value));
    require(limits.allowance >= 1e-12, "the allowance of energy is " + number(limits.allowance) + " J");
    require(limits.capacity >= limits.allowance, "the capacity is less than the allowance");
    require(limits.delay >= 0 && limits.delay <= 32, "the delay is " + std::to_string(limits.delay) + " ticks");
  }

  /// The force to pass on instead of `wanted`, for a tool that was at `position` [m] at `time` [s]. Sets
  /// energy_injected when that is less.
  Vector3 limit(const Vector3& wanted, const Vector3& position, double time, Status& status) noexcept {
    if (observer_.acting().isZero(0.0)) level_ = std::min(level_, limits_.allowance);
    const auto step = observer_.moved(position, time);
    level_ -= step.work;
    if (step.time > 0.0) level_ += limits_.damping * step.way2 / std::max(step.time, shortest_step);
    if (level_ < limits_.allowance)
      level_ = std::min(limits_.allowance, level_ + limits_.refill * std::min(step.time, longest_refill));
    level_ = std::clamp(level_, -limits_.allowance, limits_.capacity);
    if (gain() >= 1.0) return wanted;
    status.set(StatusFlag::energy_injected);
    return gain() * wanted;
  }
  /// Takes in the work of a torque on the tool since the last call of limit [J], before that is called again.
  void turned(double work) noexcept {
    if (!std::isfinite(work)) return;
    observer_.moved_by(work);
    level_ = std::clamp(level_ - work, -limits_.allowance, limits_.capacity);
  }
  /// What was rendered in the end.
  void gave(const Vector3& force) noexcept { observer_.gave(force); }
  /// The device was lost, or the tool jumped: the way to the next sample does not count.
  void forget() noexcept { observer_.forget(); }
  void reset() noexcept {
    observer_ = PassivityObserver(limits_.delay);
    level_ = limits_.allowance;
  }

  double level() const noexcept { return level_; }  ///< [J]
  double gain() const noexcept { return std::clamp(level_ / (0.5 * limits_.allowance), 0.0, 1.0); }
  const PassivityObserver& observer() const noexcept { return observer_; }
  const EnergyLimits& limits() const noexcept { return limits_; }

 private:
  static constexpr double longest_refill = 0.1;  ///< [s] a stall does not fill the tank,
  static constexpr double shortest_step = 1e-5;  ///< [s] nor do stamps that lie too close
  static void require(bool holds, const std::string& what) {
    if (!holds) raise(SetupErrorKind::bad_argument, what, "Use EnergyLimits::from(device)");
  }

  EnergyLimits limits_;
  PassivityObserver observer_;
  double level_;
};

/// The policy of a servo that observes no energy, at no cost.
struct NoEnergyTank {
  const Vector3& limit(const Vector3& wanted, const Vector3&, double, Status&) noexcept { return wanted; }
  void turned(double) noexcept {}
  static constexpr double gain() noexcept { return 1.0; }
  void gave(const Vector3&) noexcept {}
  void forget() noexcept {}
  void reset() noexcept {}
};

}}  // namespace palpate
