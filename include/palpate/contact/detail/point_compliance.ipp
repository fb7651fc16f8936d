// Definitions of point_compliance.hpp.
#pragma once

#include <palpate/contact/detail/point_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE PointCompliance::PointCompliance(int capacity)
    : block_(at(capacity) * (at(capacity) + 1) / 2),
      known_(block_.size(), 0),
      sample_(at(capacity), -1),
      moving_(at(capacity)),
      version_(at(capacity), 0),
      used_(at(capacity), 0) {}

PALPATE_INLINE void PointCompliance::begin_tick(std::uint64_t revision) noexcept {
  if (revision == revision_) return;
  revision_ = revision;
  forget();
}
PALPATE_INLINE void PointCompliance::forget() noexcept {
  std::fill(sample_.begin(), sample_.end(), -1);
}

PALPATE_INLINE void PointCompliance::reset() noexcept {
  forget();
  next_ = 0;
}

PALPATE_INLINE int PointCompliance::slot_of(int sample, int hint) noexcept {
  if (hint < 0 || sample_[at(hint)] != sample) {
    const auto found = std::find(sample_.begin(), sample_.end(), sample);
    hint = found != sample_.end() ? static_cast<int>(found - sample_.begin()) : take(sample);
  }
  used_[at(hint)] = rows_;
  return hint;
}

PALPATE_INLINE void PointCompliance::move(int slot, const ContactSample& point) noexcept {
  ContactSample& own = moving_[at(slot)];
  if (own.vertices == point.vertices && own.weights == point.weights) return;
  own = point;
  version_[at(slot)] = ++versions_ & 0xffffffffu;
}

PALPATE_INLINE void PointCompliance::compute(const TissueView& tissue, const ContactSamples& samples, int p, int q,
                                             Matrix3& block) const noexcept {
  tissue.between(point(samples, p), point(samples, q), block);
}

PALPATE_INLINE int PointCompliance::take(int sample) noexcept {
  const int capacity = static_cast<int>(sample_.size());
  while (used_[at(next_)] == rows_) next_ = next_ + 1 == capacity ? 0 : next_ + 1;
  sample_[at(next_)] = sample;
  version_[at(next_)] = ++versions_ & 0xffffffffu;
  return next_;
}

}}  // namespace palpate
