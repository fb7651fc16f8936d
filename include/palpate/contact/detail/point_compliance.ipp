// Definitions of point_compliance.hpp.
#pragma once

#include <palpate/contact/detail/point_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE PointCompliance::PointCompliance(int capacity)
    : block_(at(capacity) * (at(capacity) + 1) / 2),
      known_(block_.size(), 0),
      sample_(at(capacity), -1),
      point_(at(capacity)),
      map_(at(capacity), Matrix3::Identity()),
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

PALPATE_INLINE int PointCompliance::slot_of(const TissueView& tissue, const Candidates& points, int sample,
                                            int hint) noexcept {
  if (hint < 0 || sample_[at(hint)] != sample) {
    const auto found = std::find(sample_.begin(), sample_.end(), sample);
    hint = found != sample_.end() ? static_cast<int>(found - sample_.begin()) : take(tissue, points, sample);
  }
  used_[at(hint)] = rows_;
  return hint;
}

PALPATE_INLINE void PointCompliance::compute(const TissueView& tissue, const Candidates& points, int p, int q,
                                             Matrix3& block) const noexcept {
  const ContactSample &on_p = points.samples()[sample_[at(p)]], &on_q = points.samples()[sample_[at(q)]];
  tissue.between(on_p, on_q, block);
  if (!point_[at(p)].is_known() || !point_[at(q)].is_known()) return;
  Matrix3 added = -points.subfacet()->shown(on_p, on_q);
  if (p != q) added += SubfacetCompliance::half_space(point_[at(p)], point_[at(q)]);
  if (tissue.has_half_space_map()) added = (map(p) * added * map(q).transpose()).eval();
  block += added;
}

PALPATE_INLINE int PointCompliance::take(const TissueView& tissue, const Candidates& points, int sample) noexcept {
  const int capacity = static_cast<int>(sample_.size());
  while (used_[at(next_)] == rows_) next_ = next_ + 1 == capacity ? 0 : next_ + 1;
  sample_[at(next_)] = sample;
  point_[at(next_)] = points.half_space_point(sample);
  if (tissue.has_half_space_map()) map_[at(next_)] = tissue.half_space_map_at(points.samples()[sample]);
  version_[at(next_)] = ++versions_ & 0xffffffffu;
  return next_;
}

}}  // namespace palpate
