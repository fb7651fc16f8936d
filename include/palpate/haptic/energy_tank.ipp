// Definitions of energy_tank.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/energy_tank.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE PassivityObserver::PassivityObserver(int delay) noexcept
    : delay_(static_cast<std::size_t>(std::clamp(delay, 0, 32))) {
  forces_.fill(Vector3::Zero());
}

PALPATE_INLINE PassivityObserver::Step PassivityObserver::moved(const Vector3& position, double time) noexcept {
  Step step;
  const Vector3 path = position - last_;
  const double work = acting().dot(path), squared_path = path.squaredNorm(), dt = time - last_time_;
  if (known_ && std::isfinite(work) && std::isfinite(squared_path)) {
    step.work = work;
    step.squared_path = squared_path;
    if (dt > 0.0 && std::isfinite(dt)) step.time = dt;
    add(work);
  }
  known_ = all_finite(position);
  last_ = position;
  last_time_ = time;
  return step;
}

PALPATE_INLINE void PassivityObserver::gave(const Vector3& force) noexcept {
  newest_ = (newest_ + 1) % forces_.size();
  forces_[newest_] = force;
}

PALPATE_INLINE const Vector3& PassivityObserver::acting() const noexcept {
  return forces_[(newest_ + forces_.size() - delay_) % forces_.size()];
}

PALPATE_INLINE void PassivityObserver::add(double work) noexcept {
  if (std::isfinite(given_ + work)) given_ += work;
}

PALPATE_INLINE EnergyLimits EnergyLimits::from(const DeviceLimits& device) {
  EnergyLimits limits;
  limits.damping = 0.5 * device.stiffness / device.rate;
  limits.allowance = limits.refill = 0.05 * device.peak_force * device.peak_force / device.stiffness;
  limits.capacity = std::max(0.03 * device.length_scale * device.peak_force, limits.allowance);
  return limits;
}

PALPATE_INLINE EnergyTank::EnergyTank(const EnergyLimits& limits)
    : limits_(limits), observer_(limits.delay), level_(limits.allowance) {
  for (double value : {limits.allowance, limits.refill, limits.capacity, limits.damping})
    require(value >= 0.0 && value <= 1e9, "an energy limit is " + number(value));
  require(limits.allowance >= 1e-12, "the allowance of energy is " + number(limits.allowance) + " J");
  require(limits.capacity >= limits.allowance, "the capacity is less than the allowance");
  require(limits.delay >= 0 && limits.delay <= 32, "the delay is " + std::to_string(limits.delay) + " ticks");
}

PALPATE_INLINE Vector3 EnergyTank::limit(const Vector3& wanted, const Vector3& position, double time,
                                         Status& status) noexcept {
  if (observer_.acting().isZero(0.0)) level_ = std::min(level_, limits_.allowance);
  const auto step = observer_.moved(position, time);
  level_ -= step.work;
  if (step.time > 0.0) level_ += limits_.damping * step.squared_path / std::max(step.time, shortest_step);
  if (level_ < limits_.allowance)
    level_ = std::min(limits_.allowance, level_ + limits_.refill * std::min(step.time, longest_refill));
  level_ = std::clamp(level_, -limits_.allowance, limits_.capacity);
  if (gain() >= 1.0) return wanted;
  status.set(StatusFlag::energy_injected);
  return gain() * wanted;
}

PALPATE_INLINE void EnergyTank::rotated(double work) noexcept {
  if (!std::isfinite(work)) return;
  observer_.moved_by(work);
  level_ = std::clamp(level_ - work, -limits_.allowance, limits_.capacity);
}

PALPATE_INLINE void EnergyTank::reset() noexcept {
  observer_ = PassivityObserver(limits_.delay);
  level_ = limits_.allowance;
}

PALPATE_INLINE double EnergyTank::gain() const noexcept {
  return std::clamp(level_ / (0.5 * limits_.allowance), 0.0, 1.0);
}

PALPATE_INLINE void EnergyTank::require(bool holds, const std::string& what) {
  if (!holds) raise(SetupErrorKind::bad_argument, what, "Use EnergyLimits::from(device)");
}

}}  // namespace palpate
