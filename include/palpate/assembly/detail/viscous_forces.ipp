// Definitions of viscous_forces.hpp.
#pragma once

#include <palpate/assembly/detail/viscous_forces.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE std::vector<double> distinct_times(const std::vector<std::vector<PronyTerm>>& by_region) {
  std::vector<double> times;
  for (const auto& terms : by_region)
    for (const PronyTerm& t : terms) times.push_back(t.relaxation_time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double ViscousForces::energy(const VectorX& u) const noexcept {
  step_.apply(u, product_);
  return u.dot(0.5 * product_ + past_);
}

PALPATE_INLINE DeformationReport ViscousForces::force(const VectorX& u, VectorX& f) const noexcept {
  step_.apply(u, f);
  f += past_;
  DeformationReport report;
  report.smallest_volume_ratio = 1.0;
  return report;
}

PALPATE_INLINE void ViscousForces::begin_step(double dt) noexcept {
  if (dt != dt_) set_length(dt);
  past_.setZero();
  for (std::size_t i = 0; i < times_.size(); ++i) {
    trial_ = decay_[i] * history_[i] - gain_[i] * last_;
    fading_[i].apply(trial_, product_);
    past_ += product_;
  }
}

PALPATE_INLINE void ViscousForces::end_step(const VectorX& u) noexcept {
  for (std::size_t i = 0; i < times_.size(); ++i) history_[i] = decay_[i] * history_[i] + gain_[i] * (u - last_);
  last_ = u;
}

PALPATE_INLINE void ViscousForces::set_length(double dt) noexcept {
  dt_ = dt;
  step_.copy_values(slow_);
  for (std::size_t i = 0; i < times_.size(); ++i) {
    decay_[i] = std::exp(-dt / times_[i]);
    gain_[i] = detail::mean_decay(dt / times_[i]);
    step_.add(gain_[i], fading_[i]);
  }
}

}}  // namespace palpate
