// A handle with mass, damping and friction in a hand that is a mass, a damper and a spring.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// A hand moves with the handle it holds: its mass is added to the handle's, its damper and spring act towards the
/// place where it wants to be. Motion of the skin on the handle is not in it.
struct SimulatedHand {
  double mass = 0.0;       ///< [kg]
  double damping = 0.0;    ///< [N s/m]
  double stiffness = 0.0;  ///< [N/m]

  /// Nobody holds the device: the case in which most devices buzz first.
  static SimulatedHand none() { return {}; }
  /// A tenth of a firm grip.
  static SimulatedHand light() { return {0.0554, 0.645, 13.5}; }
  /// A human arm, as measured by van Beek et al., Scientific Reports 6 (2016), srep18004.
  static SimulatedHand firm() { return {0.554, 6.45, 135.0}; }
};

/// Where the energy of a simulated device went since it was made [J].
struct SimulatedEnergy {
  double motors = 0.0;    ///< work of the motors on the handle
  double hand = 0.0;      ///< work of the hand on the handle; below zero: the hand was given energy
  double friction = 0.0;  ///< work of Coulomb friction, <= 0 but for the step in which motion reverses
  double viscous = 0.0;   ///< work of the device's damping, <= 0
};

/// m x'' + b x' + k (x - hand) + friction = motors + push, alike in all directions, with forces that are constant while
/// it advances. Without friction the motion is exact to rounding, however long the step: Taylor series of the impulse
/// response, whose argument is kept below one half. With friction it goes in steps of `friction_step`, each exact under
/// a constant friction force that brings the velocity at its end as close to zero as the Coulomb limit allows: a handle
/// at rest rests (Moreau 1988, velocity stepping).
class SimulatedMechanics {
 public:
  /// Throws SetupError(bad_argument) unless mass is 1e-6 to 1e6 kg and the rest 0 to 1e6 in SI units and finite.
  SimulatedMechanics(double mass, double damping, double friction, const SimulatedHand& hand, const Vector3& start)
      : mass_(mass), damping_(damping), friction_(friction), hand_(hand), x_(start), hand_at_(start) {
    require(mass >= 1e-6 && mass <= 1e6, "mass", mass);
    for (const auto& [value, name] : {std::pair(damping, "damping"),
                                      {friction, "friction"},
                                      {hand.mass, "hand's mass"},
                                      {hand.damping, "hand's damping"},
                                      {hand.stiffness, "hand's stiffness"}})
      require(value >= 0.0 && value <= 1e6, name, value);
    require(start.allFinite(), "start", start.norm());
    const double m = mass + hand.mass;
    rate_ = std::max((damping + hand.damping) / m, std::sqrt(hand.stiffness / m));
  }

  /// Goes on by `duration` [s] under a constant force of the motors [N].
  void advance(double duration, const Vector3& motors) noexcept {
    if (!(duration > 0.0)) return;
    double longest = rate_ > 0.0 ? 0.5 / rate_ : infinity;
    if (friction_ > 0.0) longest = std::min(longest, friction_step_);
    const double steps = std::max(1.0, std::ceil(duration / longest - 1e-9));
    const Response response = respond(duration / steps);
    for (double i = 0.0; i < steps; ++i) step(response, motors);
  }

  /// [s] longest step with friction.
  void friction_step(double seconds) noexcept { friction_step_ = seconds; }
  void push(const Vector3& force) noexcept { push_ = force; }
  void move_hand(const Vector3& position) noexcept { hand_at_ = position; }
  const Vector3& position() const noexcept { return x_; }
  const Vector3& velocity() const noexcept { return v_; }
  const SimulatedEnergy& energy() const noexcept { return energy_; }

 private:
  static void require(bool holds, const char* what, double value) {
    if (!holds)
      raise(SetupErrorKind::bad_argument, "the " + std::string(what) + " of a simulated device is " + number(value),
            "Give SI units, up to 1e6; a mass of at least 1e-6");
  }

  /// To a unit velocity at the start: displacement, velocity at the end, and the integral of the displacement.
  struct Response {
    double s = 0.0, ds = 0.0, integral = 0.0;
  };
  /// S'' + (b/m) S' + (k/m) S = 0, S(0) = 0, S'(0) = 1, by its power series.
  Response respond(double h) const noexcept {
    const double m = mass_ + hand_.mass;
    const double bh = (damping_ + hand_.damping) / m * h, khh = hand_.stiffness / m * h * h;
    Response r;
    double before = 0.0, term = h;
    for (int n = 1; n <= 18; ++n) {
      r.s += term;
      r.ds += n * term / h;
      r.integral += h * term / (n + 1);
      const double next = -(bh * n * term + khh * before) / (n * (n + 1.0));
      before = term;
      term = next;
    }
    return r;
  }

  void step(const Response& r, const Vector3& motors) noexcept {
    const double m = mass_ + hand_.mass;
    const Vector3 from = x_, v = v_, pull = hand_at_ - from;
    const Vector3 a = (motors + push_ + hand_.stiffness * pull) / m;
    Vector3 dx = r.s * v + r.integral * a;
    v_ = r.ds * v + r.s * a;
    Vector3 friction = Vector3::Zero();
    if (friction_ > 0.0) {
      friction = -v_ * (m / r.s);
      const double needed = friction.norm();
      if (needed > friction_) friction *= friction_ / needed;
      v_ = needed > friction_ ? Vector3(v_ + friction * (r.s / m)) : Vector3::Zero();
      dx += friction * (r.integral / m);
    }
    x_ = from + dx;
    account(motors, friction, v, dx, pull);
  }

  /// What the dampers took is what is missing in the balance of all; the device's share of it, and the device's kinetic
  /// energy, tell what came through the handle.
  void account(const Vector3& motors, const Vector3& friction, const Vector3& v, const Vector3& dx,
               const Vector3& pull) noexcept {
    const double faster = 0.5 * (v_ - v).dot(v_ + v), b = damping_ + hand_.damping;
    const double spring = hand_.stiffness * (pull - 0.5 * dx).dot(dx);
    const double missing = (motors + push_ + friction).dot(dx) + spring - (mass_ + hand_.mass) * faster;
    const double viscous = b > 0.0 ? -missing * (damping_ / b) : 0.0;
    energy_.motors += motors.dot(dx);
    energy_.friction += friction.dot(dx);
    energy_.viscous += viscous;
    energy_.hand += mass_ * faster - (motors + friction).dot(dx) - viscous;
  }

  double mass_, damping_, friction_;
  SimulatedHand hand_;
  double rate_ = 0.0;            ///< [1/s] of the fastest change
  double friction_step_ = 5e-5;  ///< [s]
  Vector3 x_, v_ = Vector3::Zero();
  Vector3 hand_at_, push_ = Vector3::Zero();
  SimulatedEnergy energy_;
};

}}  // namespace palpate
