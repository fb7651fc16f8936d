// A handle with mass, damping and friction, in a hand that is modelled as a mass, a damper and a spring.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A hand moves with the handle it holds: its mass is added to that of the handle, its damper and spring act towards
/// the target position of the hand. Motion of the skin relative to the handle is not modelled.
struct SimulatedHand {
  double mass = 0.0;       ///< [kg]
  double damping = 0.0;    ///< [N s/m]
  double stiffness = 0.0;  ///< [N/m]

  /// No hand on the device: the case in which most devices become unstable first.
  static SimulatedHand none() { return {}; }
  /// A tenth of a firm grip.
  static SimulatedHand light() { return {0.0554, 0.645, 13.5}; }
  /// A human arm, as measured by van Beek et al., Scientific Reports 6 (2016), srep18004.
  static SimulatedHand firm() { return {0.554, 6.45, 135.0}; }
};

/// Energy balance of a simulated device since construction [J].
struct SimulatedEnergy {
  double motors = 0.0;    ///< work of the motors on the handle
  double hand = 0.0;      ///< work of the hand on the handle; below zero: the hand received energy
  double friction = 0.0;  ///< work of Coulomb friction, <= 0 except in the step in which motion reverses
  double viscous = 0.0;   ///< work of the device's damping, <= 0
};

/// m x'' + b x' + k (x - hand) + friction = motors + push, the same in all directions, with forces that are constant
/// during `advance`. Without friction the motion is exact to rounding for any step length: Taylor series of the impulse
/// response, whose argument is kept below one half. With friction it advances in steps of `friction_step`, each exact
/// for a constant friction force that brings the velocity at its end as close to zero as the Coulomb limit allows: a
/// handle at rest stays at rest (Moreau 1988, velocity stepping).
class SimulatedMechanics {
 public:
  /// Throws SetupError(bad_argument) unless mass is 1e-6 to 1e6 kg and the other values are 0 to 1e6 in SI units and
  /// finite.
  SimulatedMechanics(double mass, double damping, double friction, const SimulatedHand& hand, const Vector3& start);

  /// Advances by `duration` [s] under a constant force of the motors [N].
  void advance(double duration, const Vector3& motors) noexcept;

  /// [s] longest step with friction.
  void friction_step(double seconds) noexcept { friction_step_ = seconds; }
  void push(const Vector3& force) noexcept { push_ = force; }
  void move_hand(const Vector3& position) noexcept { hand_at_ = position; }
  const Vector3& position() const noexcept { return x_; }
  const Vector3& velocity() const noexcept { return v_; }
  const SimulatedEnergy& energy() const noexcept { return energy_; }

 private:
  static void require(bool holds, const char* what, double value);

  /// Response to a unit initial velocity: displacement, velocity at the end, and the integral of the displacement.
  struct Response {
    double s = 0.0, ds = 0.0, integral = 0.0;
  };
  /// S'' + (b/m) S' + (k/m) S = 0, S(0) = 0, S'(0) = 1, by its power series.
  Response respond(double h) const noexcept;

  void step(const Response& r, const Vector3& motors) noexcept;

  /// Updates the energy balance. The energy missing in the total balance is the loss of the dampers; with the device's
  /// share of it and the change of the device's kinetic energy, the work of the hand follows.
  void account(const Vector3& motors, const Vector3& friction, const Vector3& v, const Vector3& dx,
               const Vector3& pull) noexcept;

  double mass_, damping_, friction_;
  SimulatedHand hand_;
  double rate_ = 0.0;            ///< [1/s] fastest rate of change
  double friction_step_ = 5e-5;  ///< [s]
  Vector3 x_, v_ = Vector3::Zero();
  Vector3 hand_at_, push_ = Vector3::Zero();
  SimulatedEnergy energy_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/device/detail/simulated_mechanics.ipp>
#endif
