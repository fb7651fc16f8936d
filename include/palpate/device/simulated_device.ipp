// Definitions of simulated_device.hpp.
#pragma once

#include <palpate/device/simulated_device.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

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
      rendered_(with_torque(options.limits, false)),
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
  ++reads_;
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
