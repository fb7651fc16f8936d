// Definitions of simulated_device.hpp.
#pragma once

#include <palpate/device/simulated_device.hpp>
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

static_assert(HapticDevice<SimulatedDevice>);

PALPATE_INLINE SimulatedOptions SimulatedOptions::precise_stylus() {
  return {.mass = 0.075,
          .damping = 0.05,
          .friction = 0.04,
          .encoder_step = 30e-6,
          .limits = {.peak_force = 8.5, .continuous_force = 1.4, .stiffness = 800.0}};
}

PALPATE_INLINE SimulatedOptions SimulatedOptions::game_controller() {
  return {.mass = 0.1,
          .damping = 0.3,
          .friction = 0.4,
          .encoder_step = 63.5e-6,
          .limits = {.peak_force = 8.0, .continuous_force = 4.0, .stiffness = 3000.0}};
}

PALPATE_INLINE SimulatedOptions SimulatedOptions::parallel_arm() {
  return {.mass = 0.22,
          .damping = 0.2,
          .friction = 0.3,
          .encoder_step = 10e-6,
          .limits = {.peak_force = 12.0, .continuous_force = 12.0, .stiffness = 5000.0}};
}

PALPATE_INLINE SimulatedDevice::SimulatedDevice(const SimulatedOptions& options)
    : options_(options),
      mechanics_(options.mass, options.damping, options.friction, options.hand, options.start),
      rendered_(detail::with_torque(options.limits, false)),
      random_(options.seed) {
  const SimulatedOptions& o = options;
  require(o.rate >= 0.1 && o.rate <= 1e6, "rate", o.rate, "Give 0.1 to 1e6 1/s");
  require(o.encoder_step >= 0.0 && o.encoder_step <= 1.0, "encoder step", o.encoder_step, "Give 0 to 1 m");
  require(o.delay >= 0.0 && o.delay * o.rate <= 32.0, "delay", o.delay, "Give up to 32 periods");
  require(o.jitter >= 0.0 && o.jitter * o.rate < 1.0, "jitter", o.jitter, "Give less than a period");
  require(o.stall >= 0.0 && o.stall <= 1e3, "stall", o.stall, "Give 0 to 1000 s");
  require(o.stall_interval >= 0.0 && o.stall_interval <= 1e9, "stall interval", o.stall_interval, "Give seconds");
  next_stall_ = o.stall_interval > 0.0 ? o.stall_interval : infinity;
  mechanics_.friction_step(0.05 / o.rate);
}

PALPATE_INLINE ToolState SimulatedDevice::read() noexcept {
  advance_to(next_sample());
  ToolState state;
  state.time = state.now = now_;
  state.position = measured(mechanics_.position());
  state.valid = !unplugged_;
  rendered_.read_was(state.valid);
  if (!state.valid) silence();
  return state;
}

PALPATE_INLINE Status SimulatedDevice::write(const GatedForce& force) noexcept {
  const Status status = rendered_.render(force);
  schedule({now_ + options_.delay, rendered_.force()});
  return status;
}

PALPATE_INLINE DeviceLimits SimulatedDevice::limits() const noexcept {
  DeviceLimits limits = rendered_.limits();
  limits.rate = options_.rate;
  return limits;
}

PALPATE_INLINE void SimulatedDevice::stop() noexcept {
  rendered_.stop();
  silence();
}

PALPATE_INLINE void SimulatedDevice::require(bool holds, const char* what, double value, const char* hint) {
  if (!holds)
    raise(SetupErrorKind::bad_argument, "the " + std::string(what) + " of a simulated device is " + number(value),
          hint);
}

PALPATE_INLINE double SimulatedDevice::next_sample() noexcept {
  const double period = 1.0 / options_.rate;
  double t = static_cast<double>(++slot_) * period + options_.jitter * uniform();
  if (t >= next_stall_) {
    t += options_.stall;
    next_stall_ = t + options_.stall_interval;
    slot_ = static_cast<std::int64_t>(t * options_.rate);
  }
  return t;
}

PALPATE_INLINE double SimulatedDevice::uniform() noexcept {
  std::uint64_t z = (random_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

PALPATE_INLINE void SimulatedDevice::advance_to(double t) noexcept {
  while (now_ < t) {
    while (count_ > 0 && pending_[first_].time <= now_) take_next();
    const double next = count_ > 0 ? std::min(t, pending_[first_].time) : t;
    mechanics_.advance(next - now_, acting_);
    now_ = next;
  }
}

PALPATE_INLINE void SimulatedDevice::take_next() noexcept {
  acting_ = pending_[first_].force;
  first_ = (first_ + 1) % pending_.size();
  --count_;
}

PALPATE_INLINE void SimulatedDevice::schedule(const Pending& p) noexcept {
  if (count_ > 0) {
    Pending& newest = pending_[(first_ + count_ - 1) % pending_.size()];
    if (newest.time >= p.time || count_ == pending_.size()) {
      newest = p;
      return;
    }
  }
  pending_[(first_ + count_++) % pending_.size()] = p;
}

PALPATE_INLINE void SimulatedDevice::silence() noexcept {
  count_ = 0;
  acting_.setZero();
}

PALPATE_INLINE Vector3 SimulatedDevice::measured(const Vector3& x) const noexcept {
  const double step = options_.encoder_step;
  if (!(step > 0.0)) return x;
  return {step * std::round(x[0] / step), step * std::round(x[1] / step), step * std::round(x[2] / step)};
}

}}  // namespace palpate
