// Definitions of passivity_observer.hpp.
#pragma once

#include <palpate/haptic/passivity_observer.hpp>

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

PALPATE_INLINE void PassivityObserver::moved_by(double work) noexcept {
  add(work);
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

}}  // namespace palpate
