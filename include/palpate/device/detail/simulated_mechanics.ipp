// Definitions of simulated_mechanics.hpp.
#pragma once

#include <palpate/device/detail/simulated_mechanics.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE SimulatedMechanics::SimulatedMechanics(double mass, double damping, double friction,
                                                      const SimulatedHand& hand, const Vector3& start)
    : mass_(mass), damping_(damping), friction_(friction), hand_(hand), x_(start), hand_at_(start) {
  require(mass >= 1e-6 && mass <= 1e6, "mass", mass);
  for (const auto& [value, name] : {std::pair(damping, "damping"),
                                    {friction, "friction"},
                                    {hand.mass, "hand's mass"},
                                    {hand.damping, "hand's damping"},
                                    {hand.stiffness, "hand's stiffness"}})
    require(value >= 0.0 && value <= 1e6, name, value);
  require(all_finite(start), "start", start.norm());
  const double m = mass + hand.mass;
  rate_ = std::max((damping + hand.damping) / m, std::sqrt(hand.stiffness / m));
}

PALPATE_INLINE void SimulatedMechanics::advance(double duration, const Vector3& motors) noexcept {
  if (!(duration > 0.0)) return;
  double longest = rate_ > 0.0 ? 0.5 / rate_ : infinity;
  if (friction_ > 0.0) longest = std::min(longest, friction_step_);
  const double steps = std::max(1.0, std::ceil(duration / longest - 1e-9));
  const Response response = respond(duration / steps);
  for (double i = 0.0; i < steps; ++i) step(response, motors);
}

PALPATE_INLINE void SimulatedMechanics::require(bool holds, const char* what, double value) {
  if (!holds)
    raise(SetupErrorKind::bad_argument, "the " + std::string(what) + " of a simulated device is " + number(value),
          "Give SI units, up to 1e6; a mass of at least 1e-6");
}

PALPATE_INLINE SimulatedMechanics::Response SimulatedMechanics::respond(double h) const noexcept {
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

PALPATE_INLINE void SimulatedMechanics::step(const Response& r, const Vector3& motors) noexcept {
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

PALPATE_INLINE void SimulatedMechanics::account(const Vector3& motors, const Vector3& friction, const Vector3& v,
                                                const Vector3& dx, const Vector3& pull) noexcept {
  const double faster = 0.5 * (v_ - v).dot(v_ + v), b = damping_ + hand_.damping;
  const double spring = hand_.stiffness * (pull - 0.5 * dx).dot(dx);
  const double missing = (motors + push_ + friction).dot(dx) + spring - (mass_ + hand_.mass) * faster;
  const double viscous = b > 0.0 ? -missing * (damping_ / b) : 0.0;
  energy_.motors += motors.dot(dx);
  energy_.friction += friction.dot(dx);
  energy_.viscous += viscous;
  energy_.hand += mass_ * faster - (motors + friction).dot(dx) - viscous;
}

}}  // namespace palpate
